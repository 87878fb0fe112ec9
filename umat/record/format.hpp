// The file that LODE_RECORD writes and `lode rerun` reads. docs/recording.md describes it; version and layout change
// together.
//
// A file is a header and frames, all little endian. Several threads and processes append frames to one file; the header
// counts the bytes of those that are complete, which tells a host killed while writing from a file that was cut. A
// session frame opens what one process writes; a material frame gives a number to a material name with its PROPS; each
// call is one frame with everything that went in and came out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lode::record {

inline constexpr std::array<char, 8> file_mark = {'L', 'O', 'D', 'E', 'R', 'E', 'C', '\n'};
inline constexpr std::uint32_t format_version = 2;
inline constexpr std::uint32_t frame_mark = 0x464C4543u;

struct FileHeader {
    std::array<char, 8> mark = file_mark;
    std::uint32_t version = format_version;
    std::uint32_t byte_order = 0x01020304u;
    std::uint64_t complete = 0;  // bytes of the frames that were appended completely
};

enum class FrameKind : std::uint32_t { session = 1, material = 2, umat = 3, vumat = 4 };

struct FrameHeader {
    std::uint32_t mark = frame_mark;
    FrameKind kind{};
    std::uint64_t session = 0;   // which process
    std::uint64_t sequence = 0;  // of the calls of a session, in the order in which they began
    std::uint32_t size = 0;      // bytes that follow
    std::uint32_t checksum = 0;  // CRC-32 of this header with checksum 0 and of what follows
};
static_assert(sizeof(FileHeader) == 24 && sizeof(FrameHeader) == 32);

enum class Outcome : std::uint32_t {
    returned = 0,
    did_not_return = 1  // the call ended the analysis: no outputs
};

// What begins the frame of a call.
struct UmatHeader {
    std::uint32_t material = 0;
    Outcome outcome = Outcome::returned;
    std::uint32_t present = 0;  // bit i: argument i of for_each_input was not a null pointer
    std::int32_t thread = 0;
    std::int32_t ndi = 0, nshr = 0, ntens = 0, nstatv = 0, fields = 0;
    std::int32_t noel = 0, npt = 0, layer = 0, kspt = 0, kstep = 0, kinc = 0;
    std::int32_t unused = 0;
};
struct VumatHeader {
    std::uint32_t material = 0;
    Outcome outcome = Outcome::returned;
    std::uint32_t present = 0;
    std::int32_t thread = 0;
    std::int32_t nblock = 0, ndir = 0, nshr = 0, nstatev = 0, nfieldv = 0, lanneal = 0;
    std::int32_t real_size = 8;  // 4: a single-precision host
    std::int32_t increment = 0;  // of the session, counted by the changes of totalTime
    double step_time = 0.0, total_time = 0.0, dt = 0.0;
};

// The arguments of a call, in the order of their frame. Output arrays are stored only behind the inputs, and only if
// the call returned.
enum class UmatInput {
    stress,
    statev,
    sse,
    spd,
    scd,
    pnewdt,
    stran,
    dstran,
    time,
    dtime,
    temp,
    dtemp,
    predef,
    dpred,
    coords,
    drot,
    celent,
    dfgrd0,
    dfgrd1,
    count
};
enum class UmatOutput { stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, pnewdt, count };
enum class VumatInput {
    char_length,
    density,
    strain_inc,
    rel_spin_inc,
    temp_old,
    stretch_old,
    defgrad_old,
    field_old,
    stress_old,
    state_old,
    ener_intern_old,
    ener_inelas_old,
    temp_new,
    stretch_new,
    defgrad_new,
    field_new,
    count
};
enum class VumatOutput { stress_new, state_new, ener_intern_new, ener_inelas_new, strain_inc, count };

// Numbers of each.
constexpr std::size_t length(const UmatHeader& h, UmatInput argument) {
    const auto size = [](int n) { return static_cast<std::size_t>(n > 0 ? n : 0); };
    switch (argument) {
        case UmatInput::stress:
        case UmatInput::stran:
        case UmatInput::dstran:
            return size(h.ntens);
        case UmatInput::statev:
            return size(h.nstatv);
        case UmatInput::time:
            return 2;
        case UmatInput::predef:
        case UmatInput::dpred:
            return size(h.fields);
        case UmatInput::coords:
            return 3;
        case UmatInput::drot:
        case UmatInput::dfgrd0:
        case UmatInput::dfgrd1:
            return 9;
        default:
            return 1;
    }
}
constexpr std::size_t length(const UmatHeader& h, UmatOutput argument) {
    const auto n = static_cast<std::size_t>(h.ntens > 0 ? h.ntens : 0);
    switch (argument) {
        case UmatOutput::stress:
        case UmatOutput::ddsddt:
        case UmatOutput::drplde:
            return n;
        case UmatOutput::statev:
            return length(h, UmatInput::statev);
        case UmatOutput::ddsdde:
            return n * n;
        default:
            return 1;
    }
}
namespace detail {
constexpr std::size_t columns(const VumatHeader& h, int number) {
    return static_cast<std::size_t>(number > 0 ? number : 0) * static_cast<std::size_t>(h.nblock > 0 ? h.nblock : 0);
}
}  // namespace detail
constexpr std::size_t length(const VumatHeader& h, VumatInput argument) {
    switch (argument) {
        case VumatInput::strain_inc:
        case VumatInput::stress_old:
        case VumatInput::stretch_old:
        case VumatInput::stretch_new:
            return detail::columns(h, h.ndir + h.nshr);
        case VumatInput::rel_spin_inc:
            return detail::columns(h, h.nshr);
        case VumatInput::defgrad_old:
        case VumatInput::defgrad_new:
            return detail::columns(h, h.ndir + 2 * h.nshr);
        case VumatInput::field_old:
        case VumatInput::field_new:
            return detail::columns(h, h.nfieldv);
        case VumatInput::state_old:
            return detail::columns(h, h.nstatev);
        default:
            return detail::columns(h, 1);
    }
}
constexpr std::size_t length(const VumatHeader& h, VumatOutput argument) {
    switch (argument) {
        case VumatOutput::stress_new:
        case VumatOutput::strain_inc:
            return detail::columns(h, h.ndir + h.nshr);
        case VumatOutput::state_new:
            return detail::columns(h, h.nstatev);
        default:
            return detail::columns(h, 1);
    }
}

// CRC-32 (IEEE 802.3) continued from `crc`.
constexpr std::uint32_t checksum(std::span<const std::byte> bytes, std::uint32_t crc = 0) {
    constexpr auto table = [] {
        std::array<std::uint32_t, 256> t{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            std::uint32_t c = i;
            for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1u) != 0 ? 0xEDB88320u : 0u);
            t[i] = c;
        }
        return t;
    }();
    crc = ~crc;
    for (const std::byte b : bytes) crc = (crc >> 8) ^ table[(crc ^ static_cast<std::uint32_t>(b)) & 0xFFu];
    return ~crc;
}

}  // namespace lode::record

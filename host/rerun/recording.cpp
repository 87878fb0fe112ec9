#include "recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <map>
#include <span>

#include "../status.hpp"

namespace lode::host {
namespace {

using namespace record;

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
    throw Failure(Status::bad_deck, fmt::format("{}: {}", path, reason));
}

std::vector<std::byte> contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) refuse(path, "cannot be opened");
    std::vector<std::byte> bytes(static_cast<std::size_t>(file.tellg()));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file) refuse(path, "cannot be read");
    return bytes;
}

struct Malformed {};

// Takes objects off the front of a frame.
class Cursor {
  public:
    explicit Cursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class T>
    T take() {
        T object;
        std::memcpy(&object, next(sizeof object), sizeof object);
        return object;
    }
    std::string take_text() {
        const auto size = take<std::uint32_t>();
        return {reinterpret_cast<const char*>(next(size)), size};
    }
    std::vector<double> take_numbers(std::size_t count, std::size_t real_size) {
        if (real_size != sizeof(float) && real_size != sizeof(double)) throw Malformed{};
        if (count > bytes_.size() / real_size) throw Malformed{};
        std::vector<double> numbers(count);
        if (count == 0) return numbers;
        const std::byte* const source = next(count * real_size);
        if (real_size == sizeof(double)) {
            std::memcpy(numbers.data(), source, count * sizeof(double));
        } else {
            for (std::size_t i = 0; i < count; ++i) {
                float number;
                std::memcpy(&number, source + i * sizeof number, sizeof number);
                numbers[i] = static_cast<double>(number);
            }
        }
        return numbers;
    }

  private:
    const std::byte* next(std::size_t size) {
        if (size > bytes_.size()) throw Malformed{};
        const std::byte* const first = bytes_.data();
        bytes_ = bytes_.subspan(size);
        return first;
    }
    std::span<const std::byte> bytes_;
};

class Reader {
  public:
    Reader(const std::string& path, std::span<const std::byte> bytes) : path_(path), bytes_(bytes) {}

    Recording read() {
        const std::uint64_t complete = check_file_header();
        const std::uint64_t present = bytes_.size() - sizeof(FileHeader);
        // Killed while writing, a host leaves a part of a frame. It was not counted: so much may be passed over.
        std::uint64_t uncounted = present > complete ? present - complete : 0;
        std::size_t offset = sizeof(FileHeader);
        std::string damage;
        while (damage.empty() && offset < bytes_.size()) {
            damage = read_frame(offset);
            if (damage.empty()) continue;
            const std::size_t next = next_frame(offset);
            if (next - offset > uncounted) break;
            uncounted -= next - offset;
            offset = next;
            damage.clear();
        }
        if (damage.empty() && present < complete)
            damage = fmt::format("{} bytes are missing at the end of the file", complete - present);
        if (!damage.empty())
            recording_.damage = fmt::format("{} after {} whole calls (byte {} of {})", damage, recording_.calls.size(),
                                            offset, bytes_.size());
        // Frames stand in the order in which the calls ended.
        std::stable_sort(recording_.calls.begin(), recording_.calls.end(),
                         [](const RecordedCall& a, const RecordedCall& b) {
                             if (a.session != b.session) return a.session->number < b.session->number;
                             return a.sequence < b.sequence;
                         });
        return std::move(recording_);
    }

  private:
    // Returns the bytes of frames that the file must hold.
    std::uint64_t check_file_header() const {
        FileHeader header;
        if (bytes_.size() < sizeof header) refuse(path_, "too short for a recording");
        std::memcpy(&header, bytes_.data(), sizeof header);
        if (header.mark != file_mark) refuse(path_, "not a recording of Lode");
        if (header.byte_order != FileHeader{}.byte_order) refuse(path_, "recorded on a machine of other byte order");
        if (header.version != format_version)
            refuse(path_,
                   fmt::format("format version {}; this program reads version {}", header.version, format_version));
        return header.complete;
    }

    // Where the next frame could begin behind `offset`; the end of the file if nowhere.
    std::size_t next_frame(std::size_t offset) const {
        const auto mark = std::bit_cast<std::array<std::byte, sizeof frame_mark>>(frame_mark);
        const auto rest = bytes_.subspan(offset + 1);
        return static_cast<std::size_t>(std::search(rest.begin(), rest.end(), mark.begin(), mark.end()) -
                                        bytes_.begin());
    }

    // Moves `offset` behind the frame, or returns what is wrong with it.
    std::string read_frame(std::size_t& offset) {
        const std::span<const std::byte> rest = bytes_.subspan(offset);
        FrameHeader header;
        if (rest.size() < sizeof header) return "the file ends inside a frame";
        std::memcpy(&header, rest.data(), sizeof header);
        if (header.mark != frame_mark) return "no frame begins";
        if (header.size > rest.size() - sizeof header) return "the file ends inside a frame";
        const std::span<const std::byte> payload = rest.subspan(sizeof header, header.size);
        const std::uint32_t expected = header.checksum;
        header.checksum = 0;
        std::array<std::byte, sizeof header> blank;
        std::memcpy(blank.data(), &header, sizeof header);
        if (checksum(payload, checksum(blank)) != expected) return "a frame's checksum is wrong";
        try {
            interpret(header, Cursor(payload));
        } catch (const Malformed&) {
            return "a frame's contents are not as they should be";
        }
        offset += sizeof header + header.size;
        return {};
    }

    void interpret(const FrameHeader& frame, Cursor cursor) {
        switch (frame.kind) {
            case FrameKind::session: {
                RecordedSession session;
                session.number = recording_.sessions.size();
                session.process = cursor.take<std::int32_t>();
                session.library = cursor.take_text();
                session.version = cursor.take_text();
                session.instruction_set = cursor.take_text();
                session.processor = cursor.take_text();
                sessions_[frame.session] = &recording_.sessions.emplace_back(session);
                return;
            }
            case FrameKind::material: {
                const auto number = cursor.take<std::uint32_t>();
                RecordedMaterial material;
                material.name = cursor.take_text();
                const auto count = cursor.take<std::uint32_t>();
                const auto real_size = cursor.take<std::uint32_t>();
                material.constants = cursor.take_numbers(count, real_size);
                materials_[{frame.session, number}] = &recording_.materials.emplace_back(material);
                return;
            }
            case FrameKind::umat:
                return take_call<UmatHeader, UmatInput, UmatOutput>(frame, cursor);
            case FrameKind::vumat:
                return take_call<VumatHeader, VumatInput, VumatOutput>(frame, cursor);
        }
        throw Malformed{};
    }

    static std::size_t real_size(const UmatHeader&) { return sizeof(double); }
    static std::size_t real_size(const VumatHeader& header) { return static_cast<std::size_t>(header.real_size); }

    template <class Header, class Input, class Output>
    void take_call(const FrameHeader& frame, Cursor cursor) {
        const auto header = cursor.take<Header>();
        RecordedCall call;
        call.header = header;
        call.present = header.present;
        call.sequence = frame.sequence;
        const auto session = sessions_.find(frame.session);
        const auto material = materials_.find({frame.session, header.material});
        if (session == sessions_.end() || material == materials_.end()) throw Malformed{};
        call.session = session->second;
        call.material = material->second;
        for (int i = 0; i < static_cast<int>(Input::count); ++i) {
            const bool present = (header.present >> i & 1u) != 0;
            call.inputs.push_back(present
                                      ? cursor.take_numbers(length(header, static_cast<Input>(i)), real_size(header))
                                      : std::vector<double>{});
        }
        if (header.outcome == Outcome::returned)
            for (int i = 0; i < static_cast<int>(Output::count); ++i)
                call.outputs.push_back(cursor.take_numbers(length(header, static_cast<Output>(i)), real_size(header)));
        recording_.calls.push_back(std::move(call));
    }

    const std::string& path_;
    std::span<const std::byte> bytes_;
    Recording recording_;
    std::map<std::uint64_t, const RecordedSession*> sessions_;
    std::map<std::pair<std::uint64_t, std::uint32_t>, const RecordedMaterial*> materials_;
};

}  // namespace

Recording read_recording(const std::string& path, bool salvage) {
    const std::vector<std::byte> bytes = contents(path);
    Recording recording = Reader(path, bytes).read();
    if (!recording.damage.empty() && !salvage)
        refuse(path, recording.damage + "; --salvage reads what is before the damage");
    return recording;
}

const char* name_of(UmatInput argument) {
    constexpr const char* names[] = {"STRESS", "STATEV", "SSE",    "SPD",    "SCD",   "PNEWDT", "STRAN",
                                     "DSTRAN", "TIME",   "DTIME",  "TEMP",   "DTEMP", "PREDEF", "DPRED",
                                     "COORDS", "DROT",   "CELENT", "DFGRD0", "DFGRD1"};
    return names[static_cast<int>(argument)];
}
const char* name_of(UmatOutput argument) {
    constexpr const char* names[] = {"STRESS", "STATEV", "DDSDDE", "SSE",    "SPD",   "SCD",
                                     "RPL",    "DDSDDT", "DRPLDE", "DRPLDT", "PNEWDT"};
    return names[static_cast<int>(argument)];
}
const char* name_of(VumatInput argument) {
    constexpr const char* names[] = {
        "charLength", "density",  "strainInc",     "relSpinInc",    "tempOld", "stretchOld", "defgradOld", "fieldOld",
        "stressOld",  "stateOld", "enerInternOld", "enerInelasOld", "tempNew", "stretchNew", "defgradNew", "fieldNew"};
    return names[static_cast<int>(argument)];
}
const char* name_of(VumatOutput argument) {
    constexpr const char* names[] = {"stressNew", "stateNew", "enerInternNew", "enerInelasNew", "strainInc"};
    return names[static_cast<int>(argument)];
}
const char* output_name(const RecordedCall& call, std::size_t output) {
    return call.is_umat() ? name_of(static_cast<UmatOutput>(output)) : name_of(static_cast<VumatOutput>(output));
}

std::string title_of(const RecordedCall& call, std::size_t number) {
    std::string title = fmt::format("call {}: {}", number, call.material->name);
    if (call.is_umat()) {
        const UmatHeader& h = call.umat();
        title += fmt::format(", element {}, point {}, step {}, increment {}", h.noel, h.npt, h.kstep, h.kinc);
    } else {
        title += fmt::format(", block of {}, increment {}", call.vumat().nblock, call.vumat().increment);
    }
    return title;
}

}  // namespace lode::host

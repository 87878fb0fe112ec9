// Validated materials, made once and found again at every call. Reading takes no lock; entries live as long as the
// library, in a table of bounded size.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "host_profile.hpp"
#include "lode/material/model_entry.hpp"

namespace lode {

inline constexpr std::size_t cmname_length = 80;

// CMNAME taken apart (conventions page): up to 80 characters, blank padded or NUL terminated; what follows the last '@'
// counts if it begins with one; case is folded.
struct MaterialName {
    std::string full, keyword, label;
};
MaterialName parse_material_name(const char* cmname);

class Material {
  public:
    Material(const char* cmname, const double* props, int nprops);  // throws BadProperty
    ~Material();
    Material(const Material&) = delete;
    Material& operator=(const Material&) = delete;

    bool matches(const char* cmname, const double* props, int nprops) const {
        return props_.size() == static_cast<std::size_t>(nprops) && same_bits(props_.data(), props, props_.size()) &&
               std::strncmp(cmname_.data(), cmname, cmname_length) == 0;
    }

    const ModelEntry* entry = nullptr;
    const void* object = nullptr;
    std::array<int, kind_count> required_state{};  // 0 for kinds that are not served
    std::string name;                              // as messages show it
    bool labelled_plane_stress = false;            // label PS or PS-*
    std::string warnings;                          // from the constructor of the model
    std::atomic<bool> has_warned{false};

    const HostChoice host = host_choice();
    Material* next = nullptr;  // in its bucket

  private:
    // For the usual few constants a call of memcmp costs more than the whole look-up.
    static bool same_bits(const double* a, const double* b, std::size_t n) {
        if (n > 8) return std::memcmp(a, b, n * sizeof *a) == 0;
        std::uint64_t difference = 0;
        for (std::size_t i = 0; i < n; ++i)
            difference |= std::bit_cast<std::uint64_t>(a[i]) ^ std::bit_cast<std::uint64_t>(b[i]);
        return difference == 0;
    }

    std::array<char, cmname_length + 1> cmname_{};
    std::vector<double> props_;
};

namespace cache_detail {

inline constexpr std::size_t bucket_count = 256;
extern std::array<std::atomic<Material*>, bucket_count> buckets;

inline std::atomic<Material*>& bucket_of(const double* props, int nprops) {
    const auto n = static_cast<std::size_t>(nprops);
    std::uint64_t h = n;
    if (n > 0) {
        h ^= std::bit_cast<std::uint64_t>(props[0]);
        h = h * 0x9E3779B97F4A7C15u + std::bit_cast<std::uint64_t>(props[n / 2]);
        h = h * 0x9E3779B97F4A7C15u + std::bit_cast<std::uint64_t>(props[n - 1]);
    }
    return buckets[static_cast<std::size_t>((h * 0x9E3779B97F4A7C15u) >> 32) % bucket_count];
}

}  // namespace cache_detail

// The material of this call if it was made before, else null. This is the way of all calls but one.
inline Material* known_material(const char* cmname, const double* props, int nprops) {
    if (nprops < 0) nprops = 0;
    Material* m = cache_detail::bucket_of(props, nprops).load(std::memory_order_acquire);
    while (m != nullptr && !m->matches(cmname, props, nprops)) [[unlikely]] m = m->next;
    return m;
}

// Makes and validates the material of this call, unless another thread has just done so: `is_new` tells, and then
// warnings may be due. Throws BadProperty.
Material& make_material(const char* cmname, const double* props, int nprops, bool& is_new);

}  // namespace lode

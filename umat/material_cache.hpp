// Validated materials, made once and found again at every call. Reading takes no lock; entries live as long as the
// library, in a table of bounded size.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

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
        return nprops_ == nprops && same_bits(props_.get(), props, nprops) &&
               std::strncmp(cmname_.data(), cmname, cmname_length) == 0;
    }

    const ModelEntry* entry = nullptr;
    const void* object = nullptr;
    std::array<ModelEntry::UmatFunction, kind_count> umat{};  // null for kinds that are not served
    std::array<int, kind_count> required_state{};             // 0 for kinds that are not served
    const HostChoice host = host_choice();
    Material* next = nullptr;            // in its bucket
    std::string name;                    // as messages show it
    bool labelled_plane_stress = false;  // label PS or PS-*
    std::string warnings;                // from the constructor of the model
    std::atomic<bool> has_warned{false};

  private:
    // For the usual few constants a call of memcmp costs more than the whole look-up.
    static bool same_bits(const double* a, const double* b, int n) {
        if (n > 8) return std::memcmp(a, b, static_cast<std::size_t>(n) * sizeof *a) == 0;
        for (int i = 0; i < n; ++i)
            if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
        return true;
    }

    int nprops_;
    std::unique_ptr<double[]> props_;
    std::array<char, cmname_length + 1> cmname_{};
};

namespace cache_detail {

inline constexpr std::size_t bucket_count = 256;
extern std::array<std::atomic<Material*>, bucket_count> buckets;

// Of this thread; null or in the table. Eight bytes, for which the loader keeps room in every thread: no call is needed
// to find them.
[[gnu::tls_model("initial-exec")]] extern constinit thread_local Material* last_found;

// One multiplication: every call waits for it.
inline std::atomic<Material*>& bucket_of(const double* props, int nprops) {
    if (nprops <= 0) return buckets[0];
    const auto bits = [props](int i) { return std::bit_cast<std::uint64_t>(props[i]); };
    const std::uint64_t sum = bits(0) + std::rotl(bits(nprops / 2), 21) + std::rotl(bits(nprops - 1), 42);
    return buckets[static_cast<std::size_t>((sum * 0x9E3779B97F4A7C15u) >> (64 - std::bit_width(bucket_count - 1)))];
}

}  // namespace cache_detail

// The material of this call if it was made before, else null. This is the way of all calls but one.
inline Material* known_material(const char* cmname, const double* props, int nprops) {
    if (nprops < 0) nprops = 0;
    // Hosts go through an element set before they turn to the next. What the last call found is at hand at once, while
    // the table can be asked only after the constants have come and been hashed.
    Material* m = cache_detail::last_found;
    if (m != nullptr && m->matches(cmname, props, nprops)) [[likely]]
        return m;
    m = cache_detail::bucket_of(props, nprops).load(std::memory_order_acquire);
    while (m != nullptr && !m->matches(cmname, props, nprops)) m = m->next;
    if (m != nullptr) cache_detail::last_found = m;
    return m;
}

// Makes and validates the material of this call, unless another thread has just done so: `is_new` tells, and then
// warnings may be due. Throws BadProperty.
Material& make_material(const char* cmname, const double* props, int nprops, bool& is_new);

}  // namespace lode

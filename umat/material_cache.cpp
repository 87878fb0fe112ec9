#include "material_cache.hpp"

#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>

#include "dispatch.hpp"

namespace lode {
namespace {

constexpr std::size_t cmname_length = 80;
constexpr std::size_t bucket_count = 256;
// A host that varies PROPS from point to point could otherwise fill the memory; beyond this many materials each thread
// keeps the last one it made.
constexpr int most_shared_materials = 4096;

std::size_t hash_of(const double* props, int nprops) {
    const auto n = static_cast<std::size_t>(nprops > 0 ? nprops : 0);
    std::uint64_t h = n;
    if (n > 0) {
        h ^= std::bit_cast<std::uint64_t>(props[0]);
        h = h * 0x9E3779B97F4A7C15u + std::bit_cast<std::uint64_t>(props[n / 2]);
        h = h * 0x9E3779B97F4A7C15u + std::bit_cast<std::uint64_t>(props[n - 1]);
    }
    return static_cast<std::size_t>((h * 0x9E3779B97F4A7C15u) >> 32);
}

std::array<std::atomic<Material*>, bucket_count> buckets{};
std::mutex making;
int shared_materials = 0;

std::string known_keywords() {
    std::string list;
    const KernelTable& table = kernels();
    for (int i = 0; i < table.count; ++i)
        list += std::string(i == 0 ? "" : ", ") + table.entries[i]->description->keyword;
    return list;
}

}  // namespace

MaterialName parse_material_name(const char* cmname) {
    std::string_view text(cmname, strnlen(cmname, cmname_length));
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    if (!text.empty() && text.front() == '@') text.remove_prefix(text.rfind('@') + 1);
    MaterialName name;
    for (const char c : text) name.full += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const std::size_t dash = name.full.find('-');
    name.keyword = name.full.substr(0, dash);
    if (dash != std::string::npos) name.label = name.full.substr(dash + 1);
    return name;
}

Material::Material(const char* cmname, const double* props, int nprops) {
    if (nprops < 0) nprops = 0;
    std::memcpy(cmname_.data(), cmname, strnlen(cmname, cmname_length));
    props_.assign(props, props + nprops);
    hash = hash_of(props, nprops);
    const MaterialName parsed = parse_material_name(cmname);
    name = parsed.full;
    labelled_plane_stress = parsed.label == "PS" || parsed.label.starts_with("PS-");
    const KernelTable& table = kernels();
    for (int i = 0; i < table.count; ++i)
        if (parsed.keyword == table.entries[i]->description->keyword) entry = table.entries[i];
    if (entry == nullptr)
        throw BadProperty("no material model '" + parsed.keyword + "' (the part of the material name '" + name +
                          "' before the first '-'); the models are " + known_keywords());
    const Properties properties(*entry->description, name, props_.data(), nprops);
    void* storage = ::operator new (entry->size, std::align_val_t{entry->alignment});
    std::string message;
    if (!entry->construct(storage, properties, message, warnings)) {
        ::operator delete (storage, std::align_val_t{entry->alignment});
        throw BadProperty(message);
    }
    object = storage;
    for (int k = 0; k < kind_count; ++k)
        if (entry->umat[k] != nullptr)
            required_state[static_cast<std::size_t>(k)] = entry->required_state(object, static_cast<AnalysisKind>(k));
}

Material::~Material() {
    if (object == nullptr) return;
    entry->destroy(const_cast<void*>(object));
    ::operator delete (const_cast<void*>(object), std::align_val_t{entry->alignment});
}

bool Material::matches(const char* cmname, const double* props, int nprops) const {
    return props_.size() == static_cast<std::size_t>(nprops) &&
           std::memcmp(props_.data(), props, props_.size() * sizeof(double)) == 0 &&
           std::strncmp(cmname_.data(), cmname, cmname_length) == 0;
}

Material& find_material(const char* cmname, const double* props, int nprops, bool& is_new) {
    is_new = false;
    if (nprops < 0) nprops = 0;
    std::atomic<Material*>& bucket = buckets[hash_of(props, nprops) % bucket_count];
    for (Material* m = bucket.load(std::memory_order_acquire); m != nullptr; m = const_cast<Material*>(m->next))
        if (m->matches(cmname, props, nprops)) [[likely]]
            return *m;

    thread_local std::unique_ptr<Material> last;
    if (last && last->matches(cmname, props, nprops)) return *last;

    auto made = std::make_unique<Material>(cmname, props, nprops);
    const std::lock_guard lock(making);
    for (Material* m = bucket.load(std::memory_order_acquire); m != nullptr; m = const_cast<Material*>(m->next))
        if (m->matches(cmname, props, nprops)) return *m;  // another thread was faster
    is_new = true;
    if (shared_materials >= most_shared_materials) {
        last = std::move(made);
        return *last;
    }
    ++shared_materials;
    made->next = bucket.load(std::memory_order_relaxed);
    Material* shared = made.release();
    bucket.store(shared, std::memory_order_release);
    return *shared;
}

}  // namespace lode

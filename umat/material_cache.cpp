#include "material_cache.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>

#include "dispatch.hpp"

namespace lode {
namespace {

// A host that varies PROPS from point to point could otherwise fill the memory; beyond this many materials each thread
// keeps the last one it made.
constexpr int most_shared_materials = 4096;

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

constinit std::array<std::atomic<Material*>, cache_detail::bucket_count> cache_detail::buckets{};
constinit thread_local Material* cache_detail::last_found = nullptr;

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

Material::Material(const char* cmname, const double* props, int nprops)
    : nprops_(std::max(nprops, 0)), props_(new double[static_cast<std::size_t>(nprops_)]) {
    std::memcpy(cmname_.data(), cmname, strnlen(cmname, cmname_length));
    std::copy_n(props, nprops_, props_.get());
    const MaterialName parsed = parse_material_name(cmname);
    name = parsed.full;
    labelled_plane_stress = parsed.label == "PS" || parsed.label.starts_with("PS-");
    const KernelTable& table = kernels();
    for (int i = 0; i < table.count; ++i)
        if (parsed.keyword == table.entries[i]->description->keyword) entry = table.entries[i];
    if (entry == nullptr)
        throw BadProperty("no material model '" + parsed.keyword + "' (the part of the material name '" + name +
                          "' before the first '-'); the models are " + known_keywords());
    const Properties properties(*entry->description, name, props_.get(), nprops_);
    void* storage = ::operator new (entry->size, std::align_val_t{entry->alignment});
    std::string message;
    if (!entry->construct(storage, properties, message, warnings)) {
        ::operator delete (storage, std::align_val_t{entry->alignment});
        throw BadProperty(message);
    }
    object = storage;
    for (int k = 0; k < kind_count; ++k)
        if (entry->umat[k] != nullptr) {
            umat[static_cast<std::size_t>(k)] = entry->umat[k];
            required_state[static_cast<std::size_t>(k)] = entry->required_state(object, static_cast<AnalysisKind>(k));
        }
}

Material::~Material() {
    if (object == nullptr) return;
    entry->destroy(const_cast<void*>(object));
    ::operator delete (const_cast<void*>(object), std::align_val_t{entry->alignment});
}

Material& make_material(const char* cmname, const double* props, int nprops, bool& is_new) {
    is_new = false;
    if (nprops < 0) nprops = 0;
    thread_local std::unique_ptr<Material> last;
    if (last && last->matches(cmname, props, nprops)) return *last;

    auto made = std::make_unique<Material>(cmname, props, nprops);
    const std::lock_guard lock(making);
    if (Material* m = known_material(cmname, props, nprops)) return *m;  // another thread was faster
    is_new = true;
    if (shared_materials >= most_shared_materials) {
        last = std::move(made);
        return *last;
    }
    ++shared_materials;
    std::atomic<Material*>& bucket = cache_detail::bucket_of(props, nprops);
    made->next = bucket.load(std::memory_order_relaxed);
    Material* shared = made.release();
    bucket.store(shared, std::memory_order_release);
    return *shared;
}

}  // namespace lode

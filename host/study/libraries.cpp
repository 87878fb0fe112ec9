#include "libraries.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "../status.hpp"
#include "../text.hpp"

namespace lode::host {

Libraries::Libraries(const std::string& request, const std::string& single) : main_(request) {
    std::string twin = single;
    if (twin.empty()) {
        const std::filesystem::path path = main_.path();
        if (path.filename() == "liblode.so") twin = (path.parent_path() / "liblode-sp.so").string();
        std::error_code ignored;
        if (!std::filesystem::exists(twin, ignored)) return;
    }
    single_.emplace(twin);
}

std::vector<std::pair<const lode_model*, const lode_sample*>> all_samples(const Library& library) {
    std::vector<std::pair<const lode_model*, const lode_sample*>> samples;
    for (const lode_model* model : library.models())
        for (int i = 0; i < model->sample_count; ++i) samples.emplace_back(model, &model->samples[i]);
    return samples;
}

std::vector<std::pair<const lode_model*, const lode_sample*>> samples_named(const Library& library,
                                                                            const std::string& name) {
    const std::string wanted = upper(name);
    std::vector<std::pair<const lode_model*, const lode_sample*>> samples;
    std::vector<std::string> names;
    for (const auto& [model, sample] : all_samples(library)) {
        const std::string full = fmt::format("{}-{}", model->keyword, sample->label);
        if (wanted == model->keyword || wanted == full) samples.emplace_back(model, sample);
        if (names.empty() || names.back() != model->keyword) names.push_back(model->keyword);
        if (wanted.starts_with(model->keyword)) names.insert(names.end() - 1, full);
    }
    if (samples.empty())
        throw Failure(Status::usage, fmt::format("\"{}\" is no deck, and {} has no such material{}; it has {}", name,
                                                 library.path(), did_you_mean(wanted, names), joined(names)));
    return samples;
}

}  // namespace lode::host

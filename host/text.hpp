// Small helpers for words and numbers.
#ifndef LODE_HOST_TEXT_HPP
#define LODE_HOST_TEXT_HPP

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lode::host {

std::string upper(std::string_view text);
std::string trimmed(std::string_view text);
// Separated by ", ".
std::string joined(std::span<const std::string_view> words);
std::string joined(const std::vector<std::string>& words);
// ` (did you mean "..."?)` with the nearest of the words, or nothing if none is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> words);
std::string did_you_mean(std::string_view word, const std::vector<std::string>& words);

}  // namespace lode::host

#endif

#include "selection.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace lode::record {
namespace {

std::string upper(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return result;
}

[[noreturn]] void refuse(std::string_view entry, const char* allowed) {
    throw std::invalid_argument("LODE_RECORD: '" + std::string(entry) + "' must be " + allowed);
}

int number(std::string_view text, std::string_view entry, const char* allowed) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0) refuse(entry, allowed);
    return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

// "12|15-20"
std::vector<Range> ranges(std::string_view text, std::string_view entry) {
    constexpr const char* allowed = "KEY=NUMBER, KEY=FIRST-LAST or several of them with | between";
    std::vector<Range> result;
    for (const std::string_view part : split(text, '|')) {
        const std::size_t dash = part.find('-');
        const int first = number(part.substr(0, dash), entry, allowed);
        const int last = dash == std::string_view::npos ? first : number(part.substr(dash + 1), entry, allowed);
        if (last < first) refuse(entry, allowed);
        result.push_back({first, last});
    }
    return result;
}

void apply(Selection& selection, std::string_view entry) {
    const std::size_t equals = entry.find('=');
    const std::string_view key = entry.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? std::string_view{} : entry.substr(equals + 1);
    if (key == "cut" && equals == std::string_view::npos) selection.only_cut = true;
    else if (key == "material" && !value.empty())
        for (const std::string_view name : split(value, '|')) selection.materials.push_back(upper(name));
    else if (key == "element") selection.elements = ranges(value, entry);
    else if (key == "point") selection.points = ranges(value, entry);
    else if (key == "step") selection.steps = ranges(value, entry);
    else if (key == "increment") selection.increments = ranges(value, entry);
    else if (key == "last") {
        selection.ring = number(value, entry, "last=NUMBER of calls");
        if (selection.ring == 0) refuse(entry, "last=NUMBER > 0");
    } else if (key == "fields") selection.fields = number(value, entry, "fields=NUMBER of field variables");
    else refuse(entry, "material=, element=, point=, step=, increment=, last=, fields= or cut");
}

}  // namespace

Request parse_request(std::string_view value) {
    Request request;
    // A ':' in the path is not taken for the selection's: that one is followed by a key.
    std::string_view file = value;
    const std::size_t colon = value.rfind(':');
    if (colon != std::string_view::npos && value.find('/', colon) == std::string_view::npos) {
        file = value.substr(0, colon);
        for (const std::string_view entry : split(value.substr(colon + 1), ',')) apply(request.selection, entry);
    }
    if (file.empty()) throw std::invalid_argument("LODE_RECORD: no file name in '" + std::string(value) + "'");
    request.file = file;
    const std::size_t process = request.file.find("%p");
    if (process != std::string::npos) request.file.replace(process, 2, std::to_string(getpid()));
    return request;
}

bool selects(const std::vector<Range>& ranges, int number) {
    return ranges.empty() || std::any_of(ranges.begin(), ranges.end(),
                                         [number](const Range& r) { return r.first <= number && number <= r.last; });
}

bool selects_material(const Selection& selection, std::string_view name) {
    if (selection.materials.empty()) return true;
    const std::string folded = upper(name);
    const std::string keyword = folded.substr(0, folded.find('-'));
    return std::any_of(selection.materials.begin(), selection.materials.end(),
                       [&](const std::string& wanted) { return wanted == folded || wanted == keyword; });
}

}  // namespace lode::record

// Memory for the arrays of one call, each between two guard zones. After the call the zones must still hold their
// pattern (a NaN, so that reading one shows as well) and the inputs what they held before.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lode::test {

template <class Number>
class GuardedMemory {
  public:
    static constexpr std::size_t zone = 8;
    static Number pattern() {
        if constexpr (std::is_same_v<Number, double>) return std::bit_cast<double>(std::uint64_t{0x7FF8DEADBEEFCAFE});
        else if constexpr (std::is_same_v<Number, float>) return std::bit_cast<float>(std::uint32_t{0x7FC5A5A5});
        else return static_cast<Number>(0x5A5A5A5A);
    }

    explicit GuardedMemory(std::size_t capacity) : numbers_(capacity, pattern()) { arrays_.reserve(48); }

    void reset() {
        arrays_.clear();
        used_ = 0;
    }
    // An array the library may write, filled with the pattern or with given values.
    Number* output(const char* name, std::size_t count) { return place(name, count, false); }
    template <std::ranges::sized_range Source>
    Number* output(const char* name, const Source& values) {
        return fill(place(name, std::size(values), false), values);
    }
    // An array it must leave alone.
    template <std::ranges::sized_range Source>
    Number* input(const char* name, const Source& values) {
        Number* target = fill(place(name, std::size(values), true), values);
        copies_.insert(copies_.end(), target, target + std::size(values));
        return target;
    }
    Number* input(const char* name, Number value) { return input(name, std::span<const Number>(&value, 1)); }

    // The names of the arrays that were written outside, or at all where they are inputs; empty if all is well.
    std::string damage() {
        std::string names;
        std::size_t copied = 0;
        const Number guard = pattern();
        for (const Array& a : arrays_) {
            const Number* start = numbers_.data() + a.start;
            bool intact = true;
            for (std::size_t i = 0; i < zone; ++i)
                intact = intact && same(start[-static_cast<std::ptrdiff_t>(i) - 1], guard) &&
                         same(start[a.count + i], guard);
            if (!intact) names += std::string(" around ") + a.name;
            if (a.is_input) {
                if (a.count > 0 && std::memcmp(start, copies_.data() + copied, a.count * sizeof(Number)) != 0)
                    names += std::string(" in the input ") + a.name;
                copied += a.count;
            }
        }
        copies_.clear();
        return names;
    }

  private:
    struct Array {
        const char* name;
        std::size_t start, count;
        bool is_input;
    };

    static bool same(const Number& a, const Number& b) { return std::memcmp(&a, &b, sizeof(Number)) == 0; }
    template <class Source>
    static Number* fill(Number* target, const Source& values) {
        std::size_t i = 0;
        for (const auto& v : values) target[i++] = static_cast<Number>(v);
        return target;
    }
    // The caller's capacity is fixed: growing would move the arrays.
    Number* place(const char* name, std::size_t count, bool is_input) {
        const std::size_t start = used_ + zone;
        used_ = start + count;
        if (used_ + zone > numbers_.size()) throw std::length_error("GuardedMemory is too small");
        arrays_.push_back({name, start, count, is_input});
        std::fill(numbers_.begin() + static_cast<std::ptrdiff_t>(start - zone),
                  numbers_.begin() + static_cast<std::ptrdiff_t>(used_ + zone), pattern());
        return numbers_.data() + start;
    }

    std::vector<Number> numbers_, copies_;
    std::vector<Array> arrays_;
    std::size_t used_ = 0;
};

}  // namespace lode::test

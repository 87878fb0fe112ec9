// Memory for the arrays of one call, each between two guard zones that have to keep what they hold; inputs have to keep
// their values as well.
#ifndef LODE_HOST_CHECK_ARENA_HPP
#define LODE_HOST_CHECK_ARENA_HPP

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace lode::host {

// Something was written where it must not be.
struct Damage {
    std::string array;
    bool outside = false;  // else: an input
};

// What surrounds the arrays. A library that reads there answers differently to different fillings.
struct Surroundings {
    double zones = 7.25e77;    // a number that no result hides
    double outputs = 0;        // what the arrays that are output only hold on entry
    std::string_view array{};  // if not empty, only this array's zones hold `zones`, the others their usual filling
    double other_zones = 7.25e77;

    double zone_of(std::string_view name) const { return array.empty() || array == name ? zones : other_zones; }
};

template <class Number>
class Arena {
  public:
    static constexpr std::size_t zone = 32;

    // Memory for so many numbers in so many arrays: nothing moves afterwards.
    void reset(std::size_t numbers, std::size_t arrays) {
        numbers_.resize(numbers + (arrays + 1) * 2 * zone);
        arrays_.clear();
        copies_.clear();
        used_ = 0;
    }
    Number* input(const char* name, const Number* values, std::size_t count, Number guard) {
        Number* const start = place(name, count, guard, true);
        std::copy_n(values, count, start);
        copies_.insert(copies_.end(), values, values + count);
        return start;
    }
    Number* inout(const char* name, const Number* values, std::size_t count, Number guard) {
        Number* const start = place(name, count, guard, false);
        std::copy_n(values, count, start);
        return start;
    }
    Number* output(const char* name, std::size_t count, Number fill, Number guard) {
        Number* const start = place(name, count, guard, false);
        std::fill_n(start, count, fill);
        return start;
    }
    void collect_damage(std::vector<Damage>& damage) const {
        std::size_t copied = 0;
        for (const Array& a : arrays_) {
            const Number* const start = numbers_.data() + a.start;
            const auto guarded = [&a](const Number& x) { return same_bytes(&x, &a.guard, sizeof x); };
            if (!std::all_of(start - zone, start, guarded) ||
                !std::all_of(start + a.count, start + a.count + zone, guarded))
                damage.push_back({a.name, true});
            if (!a.is_input) continue;
            if (a.count > 0 && !same_bytes(start, copies_.data() + copied, a.count * sizeof(Number)))
                damage.push_back({a.name, false});
            copied += a.count;
        }
    }

  private:
    struct Array {
        const char* name;
        std::size_t start, count;
        Number guard;
        bool is_input;
    };
    static bool same_bytes(const void* a, const void* b, std::size_t size) { return std::memcmp(a, b, size) == 0; }
    Number* place(const char* name, std::size_t count, Number guard, bool is_input) {
        const std::size_t start = used_ + zone;
        used_ = start + count + zone;
        arrays_.push_back({name, start, count, guard, is_input});
        std::fill_n(numbers_.begin() + static_cast<std::ptrdiff_t>(start - zone), zone, guard);
        std::fill_n(numbers_.begin() + static_cast<std::ptrdiff_t>(start + count), zone, guard);
        return numbers_.data() + start;
    }

    std::vector<Number> numbers_, copies_;
    std::vector<Array> arrays_;
    std::size_t used_ = 0;
};

}  // namespace lode::host

#endif

// One call of a VUMAT with all its arguments as plain data, between guard zones.
#ifndef LODE_HOST_CHECK_VUMAT_CALL_HPP
#define LODE_HOST_CHECK_VUMAT_CALL_HPP

#include <array>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../rerun/recording.hpp"
#include "arena.hpp"
#include "subject.hpp"

namespace lode::host {

struct VumatCall {
    std::string name;
    Numbers props;
    record::VumatHeader header;  // nblock, ndir, nshr, nstatev, nfieldv, lanneal, times
    std::array<Numbers, static_cast<std::size_t>(record::VumatInput::count)> in;

    int points() const { return header.nblock; }
    Numbers& input(record::VumatInput i) { return in[static_cast<std::size_t>(i)]; }
    const Numbers& input(record::VumatInput i) const { return in[static_cast<std::size_t>(i)]; }
};
VumatCall call_of_vumat(const RecordedCall& recorded);
// The same with these points only, in this order.
VumatCall selected(const VumatCall& call, const std::vector<int>& points);
// All points of calls that differ in nothing else.
VumatCall joined(const std::vector<VumatCall>& calls);

struct VumatAnswer {
    bool returned = false;
    std::string message;
    int points = 0;
    std::array<Numbers, static_cast<std::size_t>(record::VumatOutput::count)> out;
    std::vector<Damage> damage;

    const Numbers& output(record::VumatOutput o) const { return out[static_cast<std::size_t>(o)]; }
    // Component `k` of a point.
    double at(record::VumatOutput o, int k, int point) const {
        return output(
            o)[static_cast<std::size_t>(k) * static_cast<std::size_t>(points) + static_cast<std::size_t>(point)];
    }
    bool finite() const;  // stressNew and stateNew
};
// The answer for one point of a block.
VumatAnswer point_of(const VumatAnswer& answer, int point);
// The name of the first output that differs in a bit, empty if none does.
std::string first_difference(const VumatAnswer& a, const VumatAnswer& b);

class VumatCaller {
  public:
    explicit VumatCaller(VumatFunction function) : function_(function) {}
    VumatAnswer operator()(const VumatCall& call, const Surroundings& around = {});

  private:
    VumatFunction function_;
    Arena<double> numbers_;
    Arena<int> integers_;
    Arena<char> letters_;
};

// A material under test through VUMAT. Points are single: checks join them into blocks.
class VumatBench {
  public:
    explicit VumatBench(const Subject& subject);

    const Subject& subject() const { return subject_; }
    const Layout& layout() const { return layout_; }
    VumatAnswer call(const VumatCall& call, const Surroundings& around = {}) { return vumat_(call, around); }

    // Whether the kind can be asked for: explicit hosts tell plane stress by the number of components alone.
    bool served() const;
    VumatCall start() const;  // of one point, with a zero increment
    // The next increment of a point; `strain` in UMAT's components. The motion does not turn.
    VumatCall next(const VumatCall& call, const VumatAnswer& answer, const Components& strain, double dt) const;
    VumatCall with_strain(const VumatCall& state, const Components& strain, double dt) const;
    // Increments along a path, one point each.
    std::vector<VumatCall> situations();

    // In UMAT's components; engineering shears.
    Components strain(const VumatCall& call) const;
    Components stress(const Numbers& values) const;
    // The same increment for UMAT.
    UmatCall as_umat(const VumatCall& call) const;

  private:
    Subject subject_;
    Layout layout_;
    std::vector<int> map_;  // for each VUMAT component the UMAT one; -1: thickness
    VumatCaller vumat_;
};

// As first_look, for a library that has no umat_. Call in a child.
FirstLook vumat_first_look(const Subject& subject);

}  // namespace lode::host

#endif

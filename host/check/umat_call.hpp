// One call of a UMAT with all its arguments as plain data, between guard zones.
#ifndef LODE_HOST_CHECK_UMAT_CALL_HPP
#define LODE_HOST_CHECK_UMAT_CALL_HPP

#include <array>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/analysis.hpp"
#include "../rerun/recording.hpp"
#include "arena.hpp"

namespace lode::host {

using Numbers = std::vector<double>;

// The largest absolute component; 0 if there is none.
inline double largest(const Components& v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0; }

struct UmatCall {
    std::string name;
    Numbers props;
    int ndi = 3, nshr = 3;
    Components stress, stran, dstran;
    Numbers statev;
    double sse = 0, spd = 0, scd = 0, pnewdt = 1;
    std::array<double, 2> time{};
    double dtime = 1, temp = 0, dtemp = 0;
    Numbers predef{0.0}, dpred{0.0};
    std::array<double, 3> coords{};
    Matrix3 drot = Matrix3::Identity(), dfgrd0 = Matrix3::Identity(), dfgrd1 = Matrix3::Identity();
    double celent = 1;
    int noel = 1, npt = 1, layer = 1, kspt = 1, kstep = 1, kinc = 1;

    int size() const { return ndi + nshr; }
};
// A recorded call; arguments that were null pointers get harmless values.
UmatCall call_of(const RecordedCall& recorded);

struct UmatAnswer {
    bool returned = false;  // false: the library ended the analysis
    std::string message;    // then, its last words
    Components stress;
    Numbers statev;
    Tangent tangent;
    double sse = 0, spd = 0, scd = 0, rpl = 0, drpldt = 0, pnewdt = 1;
    Components ddsddt, drplde;
    std::vector<Damage> damage;

    bool cut(const UmatCall& call) const { return !(pnewdt >= 1) && pnewdt != call.pnewdt; }
    bool finite() const;
    // Returned, asks for no smaller increment, and is a number.
    bool done(const UmatCall& call) const { return returned && !cut(call) && finite(); }
};
// Bit for bit, all outputs.
bool identical(const UmatAnswer& a, const UmatAnswer& b);
// The name of the first output that differs, empty if none does.
std::string first_difference(const UmatAnswer& a, const UmatAnswer& b);

class UmatCaller {
  public:
    explicit UmatCaller(UmatFunction function) : function_(function) {}
    UmatAnswer operator()(const UmatCall& call, const Surroundings& around = {});

  private:
    UmatFunction function_;
    Arena<double> numbers_;
    Arena<int> integers_;
    Arena<char> letters_;
};

}  // namespace lode::host

#endif

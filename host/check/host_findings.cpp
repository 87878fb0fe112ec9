#include "host_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "../replay/kinematics.hpp"
#include "umat_call.hpp"
#include "vumat_call.hpp"

namespace lode::host {
namespace {

using record::UmatInput;
using record::UmatOutput;
using record::VumatInput;

constexpr int shown_calls = 5;

// What was looked at and what was found, for each kind of mistake.
struct Tally {
    std::size_t looked_at = 0;
    std::vector<std::size_t> calls;  // numbers, from 1
    std::string first;               // details of the first one
};

struct HostCheck {
    const char* check;
    const char* finding;
    Verdict verdict;
    const char* what;
};
constexpr HostCheck host_checks[] = {
    {"host-components", "host-ntens", Verdict::fail, "NTENS = NDI + NSHR"},
    {"host-numbers", "host-not-finite", Verdict::fail, "finite inputs"},
    {"host-time", "host-negative-dtime", Verdict::fail, "DTIME not negative"},
    {"host-rotation", "host-drot", Verdict::fail, "DROT is a rotation"},
    {"host-gradient", "host-dfgrd-transposed", Verdict::fail, "DFGRD0, DFGRD1 not transposed"},
    {"host-strain-increment", "host-dstran", Verdict::fail, "DSTRAN is that of DFGRD0, DFGRD1"},
    {"host-shear", "host-shear-strain", Verdict::fail, "engineering shears"},
    {"host-gradient-start", "host-dfgrd0", Verdict::fail, "DFGRD0 is the last DFGRD1"},
    {"host-strain-start", "host-stran-at-end", Verdict::fail, "STRAN from the start of the increment"},
    {"host-strain-sum", "host-stran", Verdict::warning, "STRAN is the sum of the increments"},
    {"host-stress-rotation", "host-stress-not-rotated", Verdict::fail, "STRESS turned by DROT"},
    {"host-stress", "host-stress", Verdict::fail, "STRESS of the increment before"},
    {"host-state", "host-state", Verdict::fail, "STATEV of the increment before"},
    {"host-length", "host-element-length", Verdict::warning, "CELENT positive"},
    {"host-cut-back", "host-pnewdt", Verdict::warning, "PNEWDT not below 1 on entry"},
    {"host-stretch", "host-stretch", Verdict::fail, "stretch is the U of defgrad"},
    {"host-strain-inc", "host-strain-inc", Verdict::fail, "strainInc is the increment of stretch"},
    {"host-density", "host-density", Verdict::fail, "density positive"},
};

class Findings {
  public:
    void looked(const std::string& finding) { ++tallies_[finding].looked_at; }
    void found(const std::string& finding, std::size_t call, const std::string& details) {
        Tally& t = tallies_[finding];
        if (t.calls.empty()) t.first = details;
        t.calls.push_back(call);
    }
    const Tally& operator[](const std::string& finding) { return tallies_[finding]; }

  private:
    std::map<std::string, Tally> tallies_;
};

std::optional<Kind> kind_of(int ndi, int nshr) {
    if (ndi == 3 && nshr == 3) return Kind::solid;
    if (ndi == 3 && nshr == 1) return Kind::plane_strain;
    if (ndi == 2 && nshr == 1) return Kind::plane_stress;
    if (ndi == 1 && nshr == 0) return Kind::uniaxial;
    if (ndi == 1 && nshr == 1) return Kind::cohesive_2d;
    if (ndi == 1 && nshr == 2) return Kind::cohesive_3d;
    return std::nullopt;
}

bool is_rotation(const Matrix3& r) {
    constexpr double rounding = 1e-6;
    return (r.transpose() * r - Matrix3::Identity()).cwiseAbs().maxCoeff() < rounding && r.determinant() > 0;
}

// Strain and rotation that the gradients contain. Hosts integrate differently: second-order differences are theirs.
struct Motion {
    Components strain;
    Matrix3 rotation;
};
Motion motion_of(const Layout& layout, const Matrix3& F0, const Matrix3& F1) {
    const MotionIncrement motion = motion_increment(F0, F1);
    return {layout.strain_components(motion.strain), motion.rotation};
}

bool usable(const Matrix3& F) { return F.allFinite() && F.determinant() > 1e-6; }

void check_gradient(const UmatCall& call, const Layout& layout, std::size_t number, Findings& findings) {
    if (layout.cohesive() || layout.kind() == Kind::uniaxial) return;
    if (!usable(call.dfgrd0) || !usable(call.dfgrd1)) return;
    // A geometrically linear analysis has no gradients, and thermal strain is in them but not in DSTRAN.
    if (call.dfgrd0.isIdentity(0) && call.dfgrd1.isIdentity(0)) return;
    if (call.dtemp != 0) return;
    const Motion given = motion_of(layout, call.dfgrd0, call.dfgrd1);
    const Motion transposed = motion_of(layout, call.dfgrd0.transpose(), call.dfgrd1.transpose());
    const double size = std::max(largest(call.dstran), largest(given.strain));
    const double amount = size + (given.rotation - Matrix3::Identity()).norm();
    // Hosts integrate the motion in different ways, which differ in second order.
    const double strain_slack = size * (0.02 + amount) + 1e-10, rotation_slack = amount * amount + 1e-10;
    const bool turns = !call.drot.isIdentity(1e-12);
    const auto strain_error = [&](const Motion& m) { return largest(m.strain - call.dstran) / strain_slack; };
    // Above 1: more than integration explains.
    const auto error = [&](const Motion& m) {
        const double rotation = turns ? (m.rotation - call.drot).cwiseAbs().maxCoeff() / rotation_slack : 0.0;
        return std::max(strain_error(m), rotation);
    };
    const double own = error(given), other = error(transposed);
    findings.looked("host-dfgrd-transposed");
    findings.looked("host-dstran");
    findings.looked("host-shear-strain");
    if (own <= 1) return;
    constexpr double clearly = 5;
    if (other <= 1 && clearly * other < own) {
        findings.found("host-dfgrd-transposed", number,
                       "DSTRAN and DROT are the motion of the transposed gradients, not of the given ones");
        return;
    }
    Motion tensor = given;
    tensor.strain.tail(layout.nshr()) *= 0.5;
    if (error(tensor) <= 1 && clearly * error(tensor) < own) {
        findings.found("host-shear-strain", number, "DSTRAN fits the gradients with half the shears");
        return;
    }
    if (strain_error(given) > 1)
        findings.found("host-dstran", number,
                       fmt::format("differs by {:.2g} from the increment of the gradients, {:.2g}",
                                   largest(given.strain - call.dstran), largest(given.strain)));
}

// What one point has seen.
struct Accepted {
    UmatCall call;
    Components stress;
    Numbers state;
};
using PointKey = std::tuple<std::uint64_t, std::string, int, int, int, int>;

Components turned(const Layout& layout, const Components& v, const Matrix3& r, bool strain) {
    if (layout.cohesive() || layout.kind() == Kind::uniaxial || r.isIdentity(0)) return v;
    return strain ? layout.strain_components(r * layout.strain_tensor(v) * r.transpose())
                  : layout.stress_components(r * layout.stress_tensor(v) * r.transpose());
}

void check_continuity(const Accepted& before, const UmatCall& call, const Layout& layout, std::size_t number,
                      Findings& findings) {
    // CalculiX keeps stress and state in the unrotated frame; it enters with PNEWDT = -1.
    const bool unrotated = call.pnewdt == -1;
    const Matrix3 r = unrotated ? Matrix3::Identity() : call.drot;
    const double tiny = 1e-9;
    const double size = std::max(largest(before.stress), largest(call.stress));
    findings.looked("host-stress");
    findings.looked("host-stress-not-rotated");
    const Components expected = turned(layout, before.stress, r, false);
    const double off = largest(call.stress - expected), unturned = largest(call.stress - before.stress);
    // Hosts rotate by formulas of their own.
    const double turning = largest(expected - before.stress);
    if (off > 1e-6 * size + 0.02 * turning) {
        if (unturned <= 1e-6 * size && turning > 0)
            findings.found("host-stress-not-rotated", number,
                           fmt::format("DROT turns, which would change STRESS by {:.2g} of {:.2g}", turning, size));
        else findings.found("host-stress", number, fmt::format("STRESS differs by {:.2g} of {:.2g}", off, size));
    }
    findings.looked("host-state");
    double state_off = 0, state_size = 0;
    std::size_t entry = 0;
    for (std::size_t i = 0; i < std::min(before.state.size(), call.statev.size()); ++i) {
        state_size = std::max(std::abs(before.state[i]), std::abs(call.statev[i]));
        const double d = std::abs(before.state[i] - call.statev[i]);
        if (d > tiny * state_size && d > state_off) {
            state_off = d;
            entry = i + 1;
        }
    }
    if (state_off > 0)
        findings.found("host-state", number, fmt::format("STATEV({}) differs by {:.2g}", entry, state_off));
    if (!layout.cohesive() && !(before.call.dfgrd1.isIdentity(0) && call.dfgrd0.isIdentity(0))) {
        findings.looked("host-dfgrd0");
        const double d = (before.call.dfgrd1 - call.dfgrd0).cwiseAbs().maxCoeff();
        if (d > tiny) findings.found("host-dfgrd0", number, fmt::format("differs by {:.2g} from the last DFGRD1", d));
    }
    findings.looked("host-stran-at-end");
    findings.looked("host-stran");
    const Components strain = turned(layout, before.call.stran + before.call.dstran, r, true);
    const double step = largest(call.dstran), difference = largest(call.stran - strain);
    const double at_end = largest(call.stran - strain - call.dstran);
    // Logarithmic strain measures differ in second order.
    const double slack =
        0.05 * step + 0.5 * largest(strain) * (largest(strain) + (r - Matrix3::Identity()).norm()) + 1e-12;
    if (at_end < 0.1 * step && difference > 0.5 * step)
        findings.found("host-stran-at-end", number, "STRAN already contains DSTRAN");
    else if (difference > slack + 0.5 * step)
        findings.found(
            "host-stran", number,
            fmt::format("differs by {:.2g} from the sum of the increments, {:.2g}", difference, largest(strain)));
}

void check_umat_call(const RecordedCall& recorded, std::size_t number,
                     std::map<PointKey, std::vector<Accepted>>& points, Findings& findings) {
    const record::UmatHeader& h = recorded.umat();
    findings.looked("host-ntens");
    if (h.ntens != h.ndi + h.nshr) {
        findings.found("host-ntens", number, fmt::format("NTENS {}, NDI {}, NSHR {}", h.ntens, h.ndi, h.nshr));
        return;
    }
    const std::optional<Kind> kind = kind_of(h.ndi, h.nshr);
    if (!kind) return;
    const Layout layout(*kind);
    findings.looked("host-not-finite");
    // Field variables and coordinates are left uninitialised by some hosts where nobody needs them.
    for (const UmatInput i :
         {UmatInput::stress, UmatInput::statev, UmatInput::stran, UmatInput::dstran, UmatInput::time, UmatInput::dtime,
          UmatInput::temp, UmatInput::dtemp, UmatInput::drot, UmatInput::dfgrd0, UmatInput::dfgrd1}) {
        const Numbers& values = recorded.input(i);
        if (std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) continue;
        findings.found("host-not-finite", number, fmt::format("in {}", name_of(i)));
        return;
    }
    const UmatCall call = call_of(recorded);
    findings.looked("host-negative-dtime");
    if (call.dtime < 0) findings.found("host-negative-dtime", number, fmt::format("DTIME = {}", call.dtime));
    findings.looked("host-element-length");
    if (!(call.celent > 0)) findings.found("host-element-length", number, fmt::format("CELENT = {}", call.celent));
    findings.looked("host-pnewdt");
    if (call.pnewdt >= 0 && call.pnewdt < 1)
        findings.found("host-pnewdt", number, fmt::format("PNEWDT = {}", call.pnewdt));
    findings.looked("host-drot");
    if (!is_rotation(call.drot)) {
        findings.found("host-drot", number,
                       fmt::format("DROT^T DROT differs from the unit matrix by {:.2g}",
                                   (call.drot.transpose() * call.drot - Matrix3::Identity()).cwiseAbs().maxCoeff()));
        return;
    }
    check_gradient(call, layout, number, findings);
    // The last call of the point that ended where this one begins was the accepted one.
    std::vector<Accepted>& history =
        points[{recorded.session->number, recorded.material->name, h.noel, h.npt, h.layer, h.kspt}];
    const double begin = call.time[1];
    const auto reaches = [&](const Accepted& a) {
        const double end = a.call.time[1] + a.call.dtime;
        return std::abs(end - begin) <= 1e-9 * std::max({std::abs(end), std::abs(begin), a.call.dtime});
    };
    const auto before = std::find_if(history.rbegin(), history.rend(), reaches);
    if (call.dtime != 0 && before != history.rend()) check_continuity(*before, call, layout, number, findings);
    if (before == history.rend() && begin == 0) {
        findings.looked("host-stran-at-end");
        if (largest(call.dstran) > 0 && largest(call.stran - call.dstran) <= 1e-9 * largest(call.dstran))
            findings.found("host-stran-at-end", number, "STRAN of the first increment is its DSTRAN");
    }
    if (!recorded.returned() || call.dtime == 0) return;
    const double pnewdt = recorded.output(UmatOutput::pnewdt)[0];
    if (pnewdt < 1 && pnewdt != call.pnewdt) return;
    const Numbers& stress = recorded.output(UmatOutput::stress);
    // What ended before this increment began is history for good.
    std::erase_if(history, [&](const Accepted& a) { return a.call.time[1] + a.call.dtime < begin * (1 - 1e-9); });
    history.push_back({call, Eigen::Map<const Components>(stress.data(), static_cast<Eigen::Index>(stress.size())),
                       recorded.output(UmatOutput::statev)});
}

constexpr std::array<std::pair<int, int>, 9> gradient_positions{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}};

void check_vumat_call(const RecordedCall& recorded, std::size_t number, Findings& findings) {
    const VumatCall block = call_of_vumat(recorded);
    const record::VumatHeader& h = block.header;
    findings.looked("host-negative-dtime");
    if (h.dt < 0) findings.found("host-negative-dtime", number, fmt::format("dt = {}", h.dt));
    findings.looked("host-not-finite");
    for (const VumatInput i : {VumatInput::strain_inc, VumatInput::stress_old, VumatInput::state_old,
                               VumatInput::temp_old, VumatInput::temp_new, VumatInput::density}) {
        const Numbers& values = block.input(i);
        if (std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) continue;
        findings.found("host-not-finite", number, fmt::format("in {}", name_of(i)));
        return;
    }
    findings.looked("host-density");
    const auto positive = [](double x) { return x > 0; };
    const Numbers &rho = block.input(VumatInput::density), &length = block.input(VumatInput::char_length);
    if (!std::all_of(rho.begin(), rho.end(), positive)) findings.found("host-density", number, "density <= 0");
    findings.looked("host-element-length");
    if (!std::all_of(length.begin(), length.end(), positive))
        findings.found("host-element-length", number, "charLength <= 0");
    // The probe comes with made-up strains. Cohesive materials have no gradients.
    if ((h.step_time == 0 && h.total_time == 0) || h.ndir < 3) return;
    for (int p = 0; p < h.nblock; ++p) {
        const VumatCall one = selected(block, {p});
        const auto normals = static_cast<std::size_t>(h.ndir), shears = static_cast<std::size_t>(h.nshr);
        const auto tensor = [&](VumatInput i, bool symmetric) {
            Matrix3 a = Matrix3::Identity();
            const Numbers& values = one.input(i);
            for (std::size_t k = 0; k < normals; ++k)
                a(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) = values[k];
            for (std::size_t k = 0; k < shears; ++k) {
                const auto [row, column] = gradient_positions[3 + k];
                a(row, column) = values[normals + k];
                a(column, row) = symmetric ? values[normals + k] : values[normals + shears + k];
            }
            return a;
        };
        const Matrix3 F = tensor(VumatInput::defgrad_new, false), U = tensor(VumatInput::stretch_new, true);
        const Matrix3 old = tensor(VumatInput::stretch_old, true);
        if (!usable(F) || !usable(U) || !usable(old)) continue;
        const std::string place = fmt::format("point {}", p + 1);
        if (!(F.isIdentity(0) && U.isIdentity(0))) {
            findings.looked("host-stretch");
            const double off = (F.transpose() * F - U * U).cwiseAbs().maxCoeff();
            if (off > 1e-5)
                findings.found("host-stretch", number, fmt::format("{}: F^T F and U^2 differ by {:.2g}", place, off));
        }
        if (U.isIdentity(0) && old.isIdentity(0)) continue;
        const Matrix3 rate = (U - old) * (0.5 * (U + old)).inverse();
        const Matrix3 expected = 0.5 * (rate + rate.transpose());
        Matrix3 given = Matrix3::Zero();
        const Numbers& strain = one.input(VumatInput::strain_inc);
        for (std::size_t k = 0; k < normals; ++k)
            given(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) = strain[k];
        for (std::size_t k = 0; k < shears; ++k) {
            const auto [row, column] = gradient_positions[3 + k];
            given(row, column) = given(column, row) = strain[normals + k];
        }
        // Plane stress: the thickness strain is the material's answer.
        if (h.nshr == 1) given(2, 2) = expected(2, 2);
        const double size = expected.cwiseAbs().maxCoeff(), off = (given - expected).cwiseAbs().maxCoeff();
        findings.looked("host-strain-inc");
        findings.looked("host-shear-strain");
        const double allowed = 0.05 * size + 10 * size * size + 1e-6;
        if (off <= allowed) continue;
        Matrix3 halved = 0.5 * given;
        halved.diagonal() = given.diagonal();
        if ((halved - expected).cwiseAbs().maxCoeff() <= allowed)
            findings.found("host-strain-inc", number,
                           place + ": strainInc holds engineering shears; tensor shears are meant");
        else
            findings.found("host-strain-inc", number,
                           fmt::format("{}: differs by {:.2g} from {:.2g}", place, off, size));
        break;
    }
}

}  // namespace

SubjectReport check_host(const Recording& recording, const std::string& path) {
    Findings findings;
    std::map<PointKey, std::vector<Accepted>> points;
    for (std::size_t i = 0; i < recording.calls.size(); ++i) {
        const RecordedCall& call = recording.calls[i];
        if (call.is_umat()) check_umat_call(call, i + 1, points, findings);
        else check_vumat_call(call, i + 1, findings);
    }
    SubjectReport report;
    report.material = fmt::format("the host that made {} calls", recording.calls.size());
    report.kind = "recording";
    report.library = path;
    for (const HostCheck& check : host_checks) {
        const Tally& tally = findings[check.finding];
        CheckResult result;
        result.check = check.check;
        result.interface = "host";
        result.kind = report.kind;
        result.figures = fmt::format("{}: {} times looked at", check.what, tally.looked_at);
        result.applicable = tally.looked_at > 0;
        if (!tally.calls.empty()) {
            std::string numbers;
            for (std::size_t i = 0; i < std::min<std::size_t>(shown_calls, tally.calls.size()); ++i)
                numbers += fmt::format("{}{}", i > 0 ? ", " : "", tally.calls[i]);
            if (tally.calls.size() > shown_calls) numbers += ", ...";
            result.findings.push_back(
                {check.verdict, check.finding,
                 fmt::format("{} of {}, call {}: {}", tally.calls.size(), tally.looked_at, numbers, tally.first)});
        }
        report.results.push_back(std::move(result));
    }
    return report;
}

}  // namespace lode::host

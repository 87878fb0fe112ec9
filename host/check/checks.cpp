#include "checks.hpp"

namespace lode::host {

const std::vector<Check>& all_checks() {
    static const std::vector<Check> checks{
        {"determinism", Entry::umat, true, "the same call again, and in another order", check_determinism},
        {"tangent", Entry::umat, true, "DDSDDE against central differences, with a study of the step", check_tangent},
        {"symmetry", Entry::umat, true, "whether DDSDDE is symmetric", check_symmetry},
        {"objectivity", Entry::umat, true, "a rotation on top of the increment turns STRESS and nothing else",
         check_objectivity},
        {"energy", Entry::umat, false, "SSE + SPD + SCD against the work of the stresses", check_energy},
        {"closed-path", Entry::umat, false, "an elastic material comes back on a closed path", check_closed_path},
        {"zero-increment", Entry::umat, true, "DSTRAN = 0 changes nothing, also with DTIME = 0", check_zero_increment},
        {"tiny-increments", Entry::umat, true, "increments down to 1e-15 of the strain scale", check_tiny_increments},
        {"splitting", Entry::umat, true, "the same path in more and more increments, with the order", check_splitting},
        {"cut-back", Entry::umat, true, "PNEWDT, and what happens to STRESS and STATEV when it is below 1",
         check_cut_back},
        {"writes", Entry::umat, true, "writes around the arrays and to input arguments", check_writes},
        {"uninitialised", Entry::umat, true, "outputs left unset; answers that depend on what lies in or around them",
         check_uninitialised},
        {"short-arrays", Entry::umat, true, "NPROPS and NSTATV one too small", check_short_arrays},
        {"constants", Entry::umat, true, "two materials in turn", check_constants},
        {"threads", Entry::umat, true, "two threads at the same time, and static memory", check_threads},
        {"nan", Entry::umat, true, "NaN in DSTRAN", check_nan},
        {"absurd-increments", Entry::umat, true, "strains up to 30", check_absurd_increments},
        {"vumat-writes", Entry::vumat, true, "writes around the arrays and to input arguments", check_vumat_writes},
        {"vumat-outputs", Entry::vumat, true, "outputs left unset; answers that depend on what lies in or around them",
         check_vumat_outputs},
        {"vumat-block", Entry::vumat, true, "a point alone and in blocks of several sizes and orders",
         check_vumat_block},
        {"vumat-components", Entry::vumat, true, "the same increments through umat_: order and shear convention",
         check_vumat_components},
        {"vumat-frame", Entry::vumat, true, "a rotation of defgrad with the same stretch changes nothing",
         check_vumat_frame},
        {"vumat-probe", Entry::vumat, true, "the host's probe at stepTime = totalTime = 0", check_vumat_probe},
        {"vumat-energy", Entry::vumat, false, "enerInternNew against the work of the stresses", check_vumat_energy},
        {"vumat-zero-increment", Entry::vumat, false, "strainInc = 0 changes nothing", check_vumat_zero_increment},
        {"vumat-determinism", Entry::vumat, true, "the same call again, and in another order", check_vumat_determinism},
        {"vumat-threads", Entry::vumat, true, "two threads at the same time", check_vumat_threads},
        {"vumat-nan", Entry::vumat, true, "NaN in one point of a block", check_vumat_nan},
        {"vumat-absurd", Entry::vumat, false, "strains up to 3", check_vumat_absurd},
    };
    return checks;
}

}  // namespace lode::host

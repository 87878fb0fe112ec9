// Hosts differ in the frame they keep stress and state in (conventions page, "Hosts differ").
#pragma once

namespace lode {

enum class HostProfile { abaqus, calculix };

// LODE_HOST=abaqus|calculix in the environment decides; else PNEWDT <= 0 on entry gives CalculiX away.
enum class HostChoice { by_pnewdt, abaqus, calculix };
HostChoice host_choice();

constexpr HostProfile host_profile(HostChoice choice, double pnewdt_on_entry) {
    if (choice == HostChoice::by_pnewdt) return pnewdt_on_entry <= 0.0 ? HostProfile::calculix : HostProfile::abaqus;
    return choice == HostChoice::calculix ? HostProfile::calculix : HostProfile::abaqus;
}

// CalculiX leaves field variables and the element length uninitialised. They are read as these: fields of zero, as it
// has none, and a length that is not known, which softening models refuse by name.
inline constexpr double no_fields[8] = {}, unknown_length = 0.0;

// The right stretch U of F = R U, both column by column; returns F itself if it is symmetric already or det F <= 0.
const double* unrotated(const double* deformation_gradient, double* stretch);

}  // namespace lode

// A model behind function pointers: what the ABI layer knows of it. One table of entries for each instruction set.
#pragma once

#include <cstddef>
#include <string>

#include "lode/lode.h"
#include "lode/material/kind.hpp"
#include "lode/material/properties.hpp"

namespace lode {

// The arguments of one UMAT call, as the host passed them (host profile applied).
struct UmatArguments {
    double *stress, *statev, *ddsdde, *sse, *spd, *scd, *rpl, *ddsddt, *drplde, *drpldt;
    const double *dstran, *time, *dtime, *temp, *dtemp, *predef, *dpred, *drot, *celent, *dfgrd1;
    int nstatv;
};

// The arguments of one VUMAT call in double precision: columns of `stride` points.
struct VumatArguments {
    int nblock, nstatev, nfieldv;
    std::ptrdiff_t stride;
    double time_increment, time_end;
    const double *density, *temp_old, *temp_new, *field_old, *field_new, *stretch_new, *char_length;
    double* strain_increment;  // in; out: thickness strain of plane stress
    const double *stress_old, *state_old, *internal_energy_old, *inelastic_energy_old;
    double *stress_new, *state_new, *internal_energy_new, *inelastic_energy_new;
};

// What became of a call.
struct CallStatus {
    const char* failure = nullptr;  // static text: the increment cannot be done
    const char* warning = nullptr;  // static text
    double time_step_ratio = 1.0;   // PNEWDT wanted with a failure
    int failed_point = 0;           // VUMAT: 1-based index in the block
    lode_observation solves{};      // UMAT
    const char* refusal = nullptr;  // with a failure: what `failure` names must be this; the analysis ends
    double refused_value = 0.0, refused_limit = 0.0;
};

struct ModelEntry {
    const lode_model* description;
    std::size_t size, alignment;
    // Makes the material in `storage`; false with a message if PROPS are refused. Warnings are appended, one a line.
    bool (*construct)(void* storage, const Properties& properties, std::string& message, std::string& warnings);
    void (*destroy)(void* storage);
    int (*required_state)(const void* material, AnalysisKind kind);
    using UmatFunction = void (*)(const void* material, const UmatArguments& arguments, CallStatus& status);
    using VumatFunction = void (*)(const void* material, const VumatArguments& arguments, CallStatus& status);
    const UmatFunction* umat;  // a table with an entry for each kind, null where it is not served
    VumatFunction vumat[kind_count];
    VumatFunction probe[kind_count];  // first call of an explicit host: elastic, no history
};

struct KernelTable {
    const char* instruction_set;
    int lanes;
    int count;
    const ModelEntry* const* entries;
};

}  // namespace lode

// The entry points that are compared: the library's and those of the baselines.
#pragma once

#include "lode/entry_points.h"

extern "C" {
lode_umat_function baseline_umat_elastic_, baseline_umat_j2_, baseline_umat_j2_usual_, baseline_umat_j2_voce_,
    baseline_umat_neo_hooke_, empty_umat_;
lode_vumat_function baseline_vumat_elastic_, baseline_vumat_j2_, baseline_vumat_j2_simd_;
}

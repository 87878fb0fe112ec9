// The explicit entry point for double and single precision arrays; see vumat.cpp for the argument list.
#pragma once

#include "lode/material/model_entry.hpp"

namespace lode {

// Finds the material, runs the probe or the kernel on arrays of doubles, reports failures. False if refused.
// `first_point` is what the block's first point is called in messages, less one.
struct VumatHeader {
    const char* cmname;
    const double* props;
    int nprops, ndir, nshr;
    bool probe;
};
bool run_vumat(const VumatHeader& header, const VumatArguments& arguments, int first_point);

}  // namespace lode

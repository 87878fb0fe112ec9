// What a run leaves behind.
#pragma once

#include <string>
#include <vector>

namespace bar {

struct AcceptedIncrement {
    double time, size;         // end, DTIME, as parts of the whole
    double elongation, force;  // of the whole bar
    double watched;            // the largest value of the watched state
    int linear_iterations;
    std::vector<double> residuals;  // after every correction, relative to the force
};

struct Result {
    std::vector<AcceptedIncrement> increments;
    bool finished = false;
    int refused_by_material = 0;  // increments cut because of PNEWDT
    int refused_by_newton = 0;    // because equilibrium was not found
    int ranks_asking = 0;         // at most, when the material wanted a smaller increment
    unsigned long long unknowns = 0, elements = 0, points = 0;
    int ranks = 1;
    std::string linear_solver;
    struct Seconds {
        // Of the slowest rank. Assembly is without umat; processor is what the process was given of a processor, less
        // than the total where others run on the machine.
        double assembly = 0, umat = 0, solve = 0, total = 0, processor = 0;
    } seconds;
};

}  // namespace bar

// Equilibrium of the bar at small strain: the finite element program around the material points.
#pragma once

#include <mpi.h>

#include <memory>

#include "result.hpp"
#include "settings.hpp"

namespace bar {

class Problem {
  public:
    Problem(const Settings& settings, const MaterialFacts& facts, MPI_Comm communicator);
    ~Problem();
    // Pulls the bar; writes files and, on rank 0, one line an increment to standard output.
    Result run();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace bar

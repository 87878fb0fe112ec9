// mpirun -n RANKS mpi_bar [card.toml] [options]: pulls a bar until it flows. See README.md.
#include <deal.II/base/mpi.h>

#include <cstdio>
#include <exception>

#include "problem.hpp"

// A material that refuses its data in the middle of a run calls the host's XIT. It does so on one rank, and the others
// would wait for that rank for ever.
extern "C" void xit_() { MPI_Abort(MPI_COMM_WORLD, 65); }

int main(int count, char** words) {
    const dealii::Utilities::MPI::MPI_InitFinalize mpi(count, words, 1);
    const bool speaks = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    try {
        // Every rank comes to the same verdict here, so all of them end.
        const bar::Settings settings = bar::read_settings(count, words);
        const bar::MaterialFacts facts = bar::examine(settings.material);
        return bar::Problem(settings, facts, MPI_COMM_WORLD).run().finished ? 0 : 3;
    } catch (const bar::BadSettings& error) {
        if (speaks) std::fprintf(error.exit_status == 0 ? stdout : stderr, "%s\n", error.what());
        return error.exit_status;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "mpi_bar: %s\n", error.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    return 1;
}

// A host with several threads, each with elements of its own.
//   threaded_host THREADS CALLS        CALLS < 0: until killed
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "lode/entry_points.h"

namespace {

void run(int element, long calls) {
    const double props[] = {210000.0, 0.3}, identity[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double zero = 0.0, time[] = {0.0, 0.0}, dtime = 0.1, celent = 1.0, coords[] = {0, 0, 0};
    const int ndi = 3, nshr = 3, ntens = 6, nstatv = 4, nprops = 2, one = 1;
    double stress[6] = {}, statev[4] = {}, stran[6] = {};
    char name[81] = "ISO_ELASTIC-THREADED                                                            ";
    for (long call = 1; call != calls + 1; ++call) {
        const double dstran[] = {1e-5 * element, 1e-6 * static_cast<double>(call), 0, 0, 0, 0};
        double ddsdde[36], sse = 0, spd = 0, scd = 0, rpl, ddsddt[6], drplde[6], drpldt, pnewdt = 1;
        const int kinc = static_cast<int>(call);
        umat_(stress, statev, ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, stran, dstran, time, &dtime,
              &zero, &zero, &zero, &zero, name, &ndi, &nshr, &ntens, &nstatv, props, &nprops, coords, identity, &pnewdt,
              &celent, identity, identity, &element, &one, &one, &one, &one, &kinc, LODE_CMNAME_LENGTH);
        if (call == 50) {
            std::printf("running\n");
            std::fflush(stdout);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    std::vector<std::thread> threads;
    for (int i = 1; i <= std::atoi(argv[1]); ++i) threads.emplace_back(run, i, std::atol(argv[2]));
    for (std::thread& thread : threads) thread.join();
}

// A concrete bar in tension by the explicit material-point method, with ELASTIC_DECOHESIVE of the library behind
// `vumat_`. README.md has the theory and the results.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>

#include "check.hpp"
#include "figures.hpp"
#include "measures.hpp"
#include "study.hpp"

namespace {

constexpr const char* usage = R"(mpm_bar check [--threads N]
    the bar along and across the grid against theory, in seconds; exit status 0 if all is inside its bounds
mpm_bar study [--out DIRECTORY] [--finest MM] [--threads N]
    all tables and figures, N runs at a time; --finest 5 leaves out the cells of 2.5 mm
mpm_bar run [--h MM] [--angle DEGREES] [--points rotated|uniform] [--weak line|square|point]
            [--normals prescribed|free] [--criterion 0|1] [--integration N] [--smearing L_c/h]
            [--speed M/S] [--end UM] [--courant C] [--threads N] [--out DIRECTORY]
    one bar: history.csv, points.csv and figures
)";

struct Arguments {
    mpm::Settings settings;
    mpm::StudyOptions study;
    std::filesystem::path directory = "mpm_run";
    int threads = static_cast<int>(std::thread::hardware_concurrency());
    bool threads_given = false;
};

// False, and a message, if the option or its value makes no sense.
bool read_option(Arguments& a, const std::string& option, const char* value) {
    using namespace mpm;
    Settings& s = a.settings;
    const std::string word = value;
    const auto number = [&](double& target, double unit, double least, double most) {
        char* end = nullptr;
        const double x = std::strtod(value, &end);
        if (end == value || *end != '\0' || !(x >= least && x <= most)) {
            std::fprintf(stderr, "mpm_bar: %s must be a number from %g to %g, not %s\n", option.c_str(), least, most,
                         value);
            return false;
        }
        target = x * unit;
        return true;
    };
    const auto whole = [&](int& target, int least, int most) {
        double x = 0.0;
        if (!number(x, 1.0, least, most)) return false;
        target = static_cast<int>(x);
        return true;
    };
    const auto choice = [&](auto& target, std::initializer_list<const char*> words) {
        int i = 0;
        for (const char* w : words) {
            if (word == w) return target = static_cast<std::decay_t<decltype(target)>>(i), true;
            ++i;
        }
        std::fprintf(stderr, "mpm_bar: %s does not know %s\n", option.c_str(), value);
        return false;
    };
    if (option == "--h") return number(s.h, 1e-3, 1.0, 20.0);
    if (option == "--angle") return number(s.angle, 1.0, -90.0, 90.0);
    if (option == "--points") return choice(s.filling, {"rotated", "uniform"});
    if (option == "--weak") return choice(s.pattern, {"line", "square", "point"});
    if (option == "--normals") return choice(s.prescribed_normal, {"free", "prescribed"});
    if (option == "--criterion") return whole(s.criterion, 0, 1);
    if (option == "--integration") return whole(s.integration, 0, 10000);
    if (option == "--smearing") return number(s.L_c_over_h, 1.0, 0.01, 10.0);
    if (option == "--speed") return number(s.v_L, 1.0, 1e-4, 10.0);
    if (option == "--end") return number(s.end, 1e-6, 0.1, 1000.0);
    if (option == "--courant") return number(s.courant, 1.0, 0.01, 0.95);
    if (option == "--finest") return number(a.study.finest, 1e-3, 1.0, 5.0);
    if (option == "--threads") return a.threads_given = true, whole(a.threads, 1, 256);
    if (option == "--out") {
        a.directory = a.study.directory = value;
        return true;
    }
    std::fprintf(stderr, "mpm_bar: unknown option %s\n%s", option.c_str(), usage);
    return false;
}

int run(Arguments& a) {
    using namespace mpm;
    a.settings.threads = a.threads_given ? a.threads : 1;
    int shown = -1;
    const Result r = simulate(a.settings, {1.5e-5, 5e-5, 1e-4}, [&](double part) {
        if (const int percent = static_cast<int>(100.0 * part); percent / 5 != shown / 5 || shown < 0) {
            std::fprintf(stderr, "\r%3d %%", percent);
            shown = percent;
        }
    });
    const Band band = band_of(r.snapshots.back());
    std::printf("\r%s: %d points, %d steps, %.1f s\n", a.settings.name().c_str(), r.points, a.settings.steps(),
                r.seconds);
    std::printf("peak load      %10.1f N at %.2f um\nload at the end%10.1f N at %.1f um\n", r.peak, 1e6 * r.peak_at,
                r.end().loads.mean, 1e6 * r.end().loads.elongation);
    std::printf("work of the load %8.5f J = %.5f dissipated + %.5f elastic + %.5f dropped + %.5f kinetic\n",
                r.end().work, r.end().fracture, r.end().strain, r.end().dropped(), r.end().kinetic);
    std::printf("cracks         %10d points, %d failed, u_n/u_0 at most %.3f\n", band.cracked, band.failed,
                band.largest);
    std::printf("band           %10.2f mm wide, tilted by %.1f degrees; normals %.2f +- %.2f degrees from the axis\n",
                1e3 * band.width, band.tilt, band.normal_mean, band.normal_deviation);
    std::filesystem::create_directories(a.directory);
    if (!draw_run(r, a.directory)) std::puts("gnuplot is not installed or failed: no pictures");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    const std::string command = argc > 1 ? argv[1] : "";
    if (command != "check" && command != "study" && command != "run") {
        std::fputs(usage, command == "--help" || command == "help" ? stdout : stderr);
        return command == "--help" || command == "help" ? 0 : 2;
    }
    for (int i = 2; i < argc; i += 2) {
        if (i + 1 == argc) {
            std::fprintf(stderr, "mpm_bar: %s needs a value\n%s", argv[i], usage);
            return 2;
        }
        if (!read_option(arguments, argv[i], argv[i + 1])) return 2;
    }
    if (arguments.threads < 1) arguments.threads = 1;
    if (command == "check") return mpm::check(arguments.threads) ? 0 : 1;
    if (command == "run") return run(arguments);
    arguments.study.at_a_time = arguments.threads;
    return mpm::study(arguments.study) ? 0 : 1;
}

// Runs structures in CalculiX with this project's materials and prints how far they are from their references.
//   calculix_host --ccx DIRECTORY --library LIB.so --lode PROGRAM [--output DIRECTORY] [case ...]
//   calculix_host --list
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "cases.hpp"

namespace {

using namespace ccx;

constexpr int skipped = 77;  // what the tests take for "not on this machine"

fs::path default_ccx() {
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    const fs::path base = cache != nullptr ? fs::path(cache) : fs::path(home != nullptr ? home : ".") / ".cache";
    return base / "lode" / "calculix-2.20";
}

// CalculiX linked with the library, made anew where either is newer. Several of these programs may run at a time.
void link_ccx(const fs::path& ccx, const fs::path& library, const fs::path& output) {
    fs::create_directories(output);
    std::FILE* lock = std::fopen((output / "link.lock").c_str(), "w");
    if (lock == nullptr || flock(fileno(lock), LOCK_EX) != 0)
        throw std::runtime_error("cannot lock " + output.string());
    const fs::path program = output / "ccx", made_for = output / "ccx.library";
    const bool is_current = fs::exists(program) && read_text(made_for) == library.string() + "\n" &&
                            fs::last_write_time(program) > fs::last_write_time(ccx / "complete");
    if (!is_current) {
        const std::string command =
            "'" LODE_LINK_CCX "' '" + library.string() + "' '" + program.string() + "' '" + ccx.string() + "' >&2";
        if (std::system(command.c_str()) != 0) throw std::runtime_error("linking CalculiX failed");
        // What @ABAQUS_LODE_... names: upper case, no underscore.
        fs::remove(output / "libLODE.so");
        fs::create_symlink(library, output / "libLODE.so");
        write_text(made_for, library.string() + "\n");
    }
    std::fclose(lock);
}

std::string formatted(double value) {
    char text[20];
    std::snprintf(text, sizeof text, value == static_cast<int>(value) ? "%.0f" : "%.1e", value);
    return text;
}

void print(std::FILE* out, const Report& report) {
    for (const Check& check : report)
        std::fprintf(out, "  %-52s %-36s %9s %9s  %-10s %s\n", check.what.c_str(), check.reference.c_str(),
                     formatted(check.deviation).c_str(), formatted(check.tolerance).c_str(), check.newton.c_str(),
                     check.passed() ? "pass" : "FAIL");
    std::fflush(out);
}

int run(const std::vector<std::string>& arguments) {
    fs::path ccx = default_ccx(), library, lode, output = "calculix";
    std::vector<std::string> chosen;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& word = arguments[i];
        if (word == "--list") {
            for (const Case& c : cases) std::printf("%-20s %s\n", c.name, c.title);
            return 0;
        }
        fs::path* const value = word == "--ccx"       ? &ccx
                                : word == "--library" ? &library
                                : word == "--lode"    ? &lode
                                : word == "--output"  ? &output
                                                      : nullptr;
        if (value == nullptr) chosen.push_back(word);
        else if (++i < arguments.size()) *value = arguments[i];
    }
    if (library.empty() || lode.empty()) {
        std::fprintf(stderr, "--library and --lode are needed\n");
        return 2;
    }
    if (!fs::exists(ccx / "complete")) {
        std::printf("CalculiX is not built: examples/calculix/build-ccx does that\n");
        return skipped;
    }
    library = fs::canonical(library);
    output = fs::absolute(output);
    link_ccx(ccx, library, output);
    const Host host(ccx, library, lode, output);

    int passed = 0, failed = 0;
    std::FILE* const table =
        std::fopen((output / (chosen.size() == 1 ? chosen[0] + ".txt" : "table.txt")).c_str(), "w");
    char heading[160];
    std::snprintf(heading, sizeof heading, "  %-52s %-36s %9s %9s  %s\n", "", "reference", "deviation", "tolerance",
                  "iterations");
    for (std::FILE* out : {stdout, table}) std::fputs(heading, out);
    for (const std::string& name : chosen) {
        bool known = false;
        for (const Case& c : cases) known = known || name == c.name;
        if (!known) throw std::runtime_error("no case " + name + "; --list names them");
    }
    for (const Case& c : cases) {
        bool wanted = chosen.empty();
        for (const std::string& name : chosen) wanted = wanted || name == c.name;
        if (!wanted) continue;
        const auto start = std::chrono::steady_clock::now();
        Report report;
        std::string problem;
        try {
            c.run(host, report);
        } catch (const std::exception& error) {
            problem = error.what();
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        for (std::FILE* out : {stdout, table}) {
            std::fprintf(out, "%s (%.0f s)\n", c.title, seconds);
            print(out, report);
            if (!problem.empty()) std::fprintf(out, "  FAIL: %s\n", problem.c_str());
        }
        for (const Check& check : report) ++(check.passed() ? passed : failed);
        if (!problem.empty()) ++failed;
    }
    for (std::FILE* out : {stdout, table}) std::fprintf(out, "%d passed, %d failed\n", passed, failed);
    std::fclose(table);
    return failed == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
    try {
        return run({words + 1, words + count});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "calculix_host: %s\n", error.what());
        return 1;
    }
}

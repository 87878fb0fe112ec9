#include "gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>

namespace lode::host {
namespace {

// Runs gnuplot where the script is, silently; its exit status, 127 if there is no gnuplot.
int run_gnuplot(const std::filesystem::path& script) {
    const std::string directory = script.parent_path().empty() ? "." : script.parent_path().string();
    const std::string name = script.filename().string();
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
        const int sink = open("/dev/null", O_WRONLY);
        dup2(sink, STDOUT_FILENO);
        dup2(sink, STDERR_FILENO);
        if (chdir(directory.c_str()) != 0) _exit(1);
        execlp("gnuplot", "gnuplot", name.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

std::string single_quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

std::string double_quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\\\"") : std::string(1, c);
    return result + "\"";
}

std::string figure_style() {
    return R"(set encoding utf8
set minussign
set border 3 lw 0.8 lc rgb '#404040'
set tics nomirror out scale 0.6 textcolor rgb '#202020'
set grid lt 1 dt solid lw 0.5 lc rgb '#e0e0e0'
)";
}

std::string terminals(const std::string& stem, const std::string& plot, Width width) {
    const std::string name = std::filesystem::path(stem).filename().string();
    return fmt::format(R"(set terminal pngcairo size {},800 font 'Noto Sans,13' fontscale 1.2 enhanced
set output {}
{}
set terminal svg size {},500 font 'Noto Sans,DejaVu Sans,sans-serif,13' enhanced background 'white' dynamic
set output {}
replot
set output
)",
                       width == Width::wide ? 1700 : 1200, single_quoted(name + ".png"), plot,
                       width == Width::wide ? 1080 : 760, single_quoted(name + ".svg"));
}

std::string curve_colour(std::size_t index) {
    constexpr std::array<const char*, 6> colours{"#1f5fa8", "#c8501e", "#2e8540", "#7b3fa0", "#a67c00", "#444444"};
    return colours[index % colours.size()];
}

std::string draw_script(const std::string& stem, const std::string& script) {
    const std::filesystem::path path = stem + ".gp";
    std::FILE* const file = std::fopen(path.c_str(), "w");
    if (file == nullptr) return "cannot write " + path.string();
    std::fwrite(script.data(), 1, script.size(), file);
    std::fclose(file);
    const int status = run_gnuplot(path);
    if (status == 127) return "gnuplot is not installed: " + path.string() + " is there, its pictures are not";
    if (status != 0) return fmt::format("gnuplot refused {} (status {})", path.string(), status);
    return {};
}

}  // namespace lode::host

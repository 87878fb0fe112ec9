// Writes the ratio tables of docs/performance.md from what Google Benchmark measured.
#pragma once

#include <benchmark/benchmark.h>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace lode::bench {

enum class Interface { umat, vumat };

// One measured case, in the order of the table.
struct Case {
    std::string benchmark;  // name of the Google Benchmark run
    Interface interface = Interface::umat;
    std::string group, material, kind;
    int points = 0;     // in a call: VUMAT block length
    double target = 0;  // in U or V; 0: there is none
    bool finite_strain = false;
};

struct Measurement {
    double ns = 0, cv = 0, active = -1;
    std::string error;
};

// Prints progress like the console reporter and keeps median and coefficient of variation of every run.
class Collector : public benchmark::ConsoleReporter {
  public:
    Collector() : ConsoleReporter(OO_None) {}
    void ReportRuns(const std::vector<Run>& runs) override;
    const Measurement* find(const std::string& benchmark) const;

  private:
    std::map<std::string, Measurement> measured_;
};

// Names of the runs that the ratios refer to.
inline constexpr const char* unit_u = "umat/baseline/J2, Fortran/3D";
inline constexpr const char* unit_v = "vumat128/baseline/J2, Fortran vectorised/3D";
inline constexpr const char* usual_form_u = "umat/baseline/J2, Fortran usual form/3D";
inline constexpr const char* usual_form_v = "vumat128/baseline/J2, Fortran usual form/3D";
inline constexpr const char* copy_run = "copy";
inline constexpr int small_block = 128, odd_block = 144, large_block = 1000000;

void write_report(std::ostream& out, const std::vector<Case>& cases, const Collector& measured);

}  // namespace lode::bench

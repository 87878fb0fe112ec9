#include "dispatch.hpp"

#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>

#include "variants.inc"

namespace lode {
namespace {

bool machine_has([[maybe_unused]] std::string_view instruction_set) {
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (instruction_set == "x86-64-v2") return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2");
    if (instruction_set == "x86-64-v3") return v3;
    if (instruction_set == "x86-64-v4")
        return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
#endif
    return true;
}

const KernelTable& pick() {
    const char* wanted = std::getenv("LODE_ISA");
    const KernelTable* best = variants[0];
    for (const KernelTable* table : variants) {
        if (!machine_has(table->instruction_set)) break;
        best = table;
        if (wanted != nullptr && std::strcmp(wanted, table->instruction_set) == 0) break;
    }
    return *best;
}

}  // namespace

const KernelTable& kernels() {
    static const KernelTable& table = pick();
    return table;
}

}  // namespace lode

// What LODE_RECORD has written, in memory (docs/recording.md).
#ifndef LODE_HOST_RERUN_RECORDING_HPP
#define LODE_HOST_RERUN_RECORDING_HPP

#include <cstdint>
#include <deque>
#include <string>
#include <variant>
#include <vector>

#include "format.hpp"

namespace lode::host {

struct RecordedSession {
    std::uint64_t number = 0;
    int process = 0;
    std::string library, version, instruction_set, processor;
};
struct RecordedMaterial {
    std::string name;
    std::vector<double> constants;
};

// One call. Numbers of a single-precision host are held as doubles, which loses nothing.
struct RecordedCall {
    const RecordedSession* session = nullptr;
    const RecordedMaterial* material = nullptr;
    std::uint64_t sequence = 0;
    std::variant<record::UmatHeader, record::VumatHeader> header;
    std::uint32_t present = 0;
    std::vector<std::vector<double>> inputs;   // by UmatInput or VumatInput; empty where a null pointer was passed
    std::vector<std::vector<double>> outputs;  // by UmatOutput or VumatOutput; none if the call did not return

    bool is_umat() const { return header.index() == 0; }
    const record::UmatHeader& umat() const { return std::get<0>(header); }
    const record::VumatHeader& vumat() const { return std::get<1>(header); }
    bool returned() const { return !outputs.empty(); }
    const std::vector<double>& input(record::UmatInput i) const { return inputs[static_cast<std::size_t>(i)]; }
    const std::vector<double>& input(record::VumatInput i) const { return inputs[static_cast<std::size_t>(i)]; }
    const std::vector<double>& output(record::UmatOutput i) const { return outputs[static_cast<std::size_t>(i)]; }
    const std::vector<double>& output(record::VumatOutput i) const { return outputs[static_cast<std::size_t>(i)]; }
};

struct Recording {
    std::deque<RecordedSession> sessions;
    std::deque<RecordedMaterial> materials;
    std::vector<RecordedCall> calls;  // sessions in the order of the file, calls in the order in which they began
    std::string damage;               // what was found behind the last whole frame; empty if nothing
};

// Throws Failure naming what is wrong. A file that is damaged behind some whole frames is refused too, unless
// `salvage`: then the calls before the damage are returned.
Recording read_recording(const std::string& path, bool salvage);

// Names of the arguments, as in the manuals of the hosts.
const char* name_of(record::UmatInput argument);
const char* name_of(record::UmatOutput argument);
const char* name_of(record::VumatInput argument);
const char* name_of(record::VumatOutput argument);
// "STRESS" or "stressNew": of an output of this call.
const char* output_name(const RecordedCall& call, std::size_t output);
// "call 12: ISO_PLASTIC-STEEL, element 3, point 1, step 1, increment 5".
std::string title_of(const RecordedCall& call, std::size_t number);

}  // namespace lode::host

#endif

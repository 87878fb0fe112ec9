// Runs somebody else's code in a child process: whatever it does there, this process goes on.
#ifndef LODE_HOST_CHECK_CHILD_HPP
#define LODE_HOST_CHECK_CHILD_HPP

#include <functional>
#include <string>

namespace lode::host {

// How a child came to its end.
struct ChildEnd {
    enum class How { answered, crashed, exited, timed_out } how = How::answered;
    std::string answer;    // what the function returned
    std::string activity;  // what it was doing last
    std::string output;    // the end of what was printed
    int code = 0;          // signal or exit status
};

// `run` in a child process of at most so many seconds. Nothing of it shows: printing and memory end with the child.
ChildEnd in_child(const std::function<std::string()>& run, double seconds);

// Says in a child what comes next; a crash or an endless loop is then reported with these words.
void doing(const std::string& what);

// "was ended by signal 11 (Segmentation fault)", "exited with status 2", "did not return within 10 s".
std::string description(const ChildEnd& end, double seconds);

}  // namespace lode::host

#endif

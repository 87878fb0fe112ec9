// The comparison with theory in seconds: what the test of this example runs.
#pragma once

namespace mpm {

// Prints a table of values and their bounds; true if all are inside. Runs several scenes at a time.
bool check(int at_a_time);

}  // namespace mpm

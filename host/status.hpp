// How a run of `lode` can end, and the exceptions that say so.
#ifndef LODE_HOST_STATUS_HPP
#define LODE_HOST_STATUS_HPP

#include <stdexcept>

namespace lode::host {

// The exit status of the program.
enum class Status {
    success = 0,
    usage = 1,
    bad_deck = 2,
    not_converged = 3,
    refused = 4,
    not_loaded = 5,
    different = 6,
    not_verified = 7,
    failed_check = 8
};

class Failure : public std::runtime_error {
  public:
    Failure(Status status, const std::string& message) : std::runtime_error(message), status_(status) {}
    Status status() const { return status_; }

  private:
    Status status_;
};

// `what()` reads file:line: key: message.
struct BadDeck : Failure {
    explicit BadDeck(const std::string& message) : Failure(Status::bad_deck, message) {}
};
// The shared object or a symbol in it is not there.
struct NotLoaded : Failure {
    explicit NotLoaded(const std::string& message) : Failure(Status::not_loaded, message) {}
};
// The library refused the material, or ended the analysis through XIT.
struct Refused : Failure {
    explicit Refused(const std::string& message) : Failure(Status::refused, message) {}
};

}  // namespace lode::host

#endif

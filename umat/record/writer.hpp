// The open recording of this process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "format.hpp"
#include "selection.hpp"

namespace lode::record {

// Bytes of a frame as they grow.
class Bytes {
  public:
    void append(const void* data, std::size_t size) {
        const auto* const first = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), first, first + size);
    }
    template <class T>
    void append(const T& object) {
        append(&object, sizeof object);
    }
    void append(std::string_view text) {
        append(static_cast<std::uint32_t>(text.size()));
        append(text.data(), text.size());
    }
    std::byte* data() { return bytes_.data(); }
    std::size_t size() const { return bytes_.size(); }
    void clear() { bytes_.clear(); }
    std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
};

// Frames are appended by single writes to a file opened for appending: threads and processes do not tear each other's,
// and what is in the file when the host is killed is complete.
class Writer {
  public:
    // `library` says what is recorded. Throws std::runtime_error if the file cannot be used.
    Writer(const Request& request, std::string_view library, std::string_view version,
           std::string_view instruction_set);
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    const Selection& selection() const { return selection_; }
    // Number of a material in this session; its frame is written when it is new.
    std::uint32_t material(std::string_view name, const void* props, std::size_t nprops, std::size_t real_size);
    // Number of the explicit increment that `total_time` belongs to.
    int explicit_increment(double total_time);
    std::uint64_t next_call();
    // The frame of a call, its header in front and still to be completed.
    void write_call(FrameKind kind, std::uint64_t sequence, Bytes& frame);
    // Writes what a ring holds back.
    void flush();

  private:
    void seal(FrameKind kind, std::uint64_t sequence, Bytes& frame) const;
    void put(const void* data, std::size_t size);     // a frame, counted in the file header
    bool append(const void* data, std::size_t size);  // false, and no more is written, if it failed

    Selection selection_;
    std::string file_name_;
    int file_ = -1;
    int header_ = -1;  // the same file, to count in its header
    std::uint64_t session_;
    std::mutex mutex_;
    std::map<std::string, std::uint32_t> materials_;  // by the bytes of their frames
    std::deque<std::vector<std::byte>> ring_;
    std::uint64_t calls_ = 0;
    int increment_ = 0;
    double last_time_ = -1.0;
};

}  // namespace lode::record

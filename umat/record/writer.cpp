#include "writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace lode::record {
namespace {

std::string processor() {
    std::string name = "unknown processor";
    std::FILE* const info = std::fopen("/proc/cpuinfo", "re");
    if (info == nullptr) return name;
    char line[256];
    while (std::fgets(line, sizeof line, info) != nullptr) {
        const char* const value = std::strchr(line, ':');
        if (std::strncmp(line, "model name", 10) != 0 || value == nullptr) continue;
        name = value + 1 + (value[1] == ' ' ? 1 : 0);
        if (!name.empty() && name.back() == '\n') name.pop_back();
        break;
    }
    std::fclose(info);
    return name;
}

std::uint64_t new_session() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto ticks = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
    return (ticks * 0x9E3779B97F4A7C15u) ^ static_cast<std::uint64_t>(getpid());
}

[[noreturn]] void refuse(const std::string& file, const std::string& reason) {
    throw std::runtime_error("LODE_RECORD: cannot record to " + file + ": " + reason);
}

}  // namespace

Writer::Writer(const Request& request, std::string_view library, std::string_view version,
               std::string_view instruction_set)
    : selection_(request.selection), file_name_(request.file), session_(new_session()) {
    file_ = open(file_name_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file_ < 0) refuse(file_name_, std::strerror(errno));
    // Of several processes the first one writes the header.
    flock(file_, LOCK_EX);
    struct stat status {};
    const FileHeader own;
    std::string reason;
    if (fstat(file_, &status) != 0) reason = std::strerror(errno);
    else if (status.st_size == 0) append(&own, sizeof own);
    else {
        FileHeader found;
        if (pread(file_, &found, sizeof found, 0) != static_cast<ssize_t>(sizeof found) || found.mark != own.mark)
            reason = "the file exists and is not a recording";
        else if (found.version != own.version)
            reason = "the file exists and has format version " + std::to_string(found.version);
    }
    flock(file_, LOCK_UN);
    if (!reason.empty()) {
        close(file_);
        refuse(file_name_, reason);
    }
    // A descriptor of its own: what is written through one with O_APPEND lands at the end, wherever it was meant to go.
    header_ = open(file_name_.c_str(), O_RDWR | O_CLOEXEC);
    Bytes frame;
    frame.append(FrameHeader{});
    frame.append(static_cast<std::int32_t>(getpid()));
    frame.append(library);
    frame.append(version);
    frame.append(instruction_set);
    frame.append(std::string_view(processor()));
    seal(FrameKind::session, 0, frame);
    put(frame.data(), frame.size());
}

Writer::~Writer() {
    flush();
    if (header_ >= 0) close(header_);
    if (file_ >= 0) close(file_);
}

std::uint32_t Writer::material(std::string_view name, const void* props, std::size_t nprops, std::size_t real_size) {
    Bytes key;
    key.append(name);
    key.append(static_cast<std::uint32_t>(nprops));
    key.append(static_cast<std::uint32_t>(real_size));
    key.append(props, nprops * real_size);
    const std::lock_guard lock(mutex_);
    const auto [place, is_new] =
        materials_.try_emplace(std::string(reinterpret_cast<const char*>(key.data()), key.size()),
                               static_cast<std::uint32_t>(materials_.size() + 1));
    if (is_new) {
        Bytes frame;
        frame.append(FrameHeader{});
        frame.append(place->second);
        frame.append(place->first.data(), place->first.size());
        seal(FrameKind::material, 0, frame);
        put(frame.data(), frame.size());
    }
    return place->second;
}

int Writer::explicit_increment(double total_time) {
    const std::lock_guard lock(mutex_);
    if (total_time != last_time_) ++increment_;
    last_time_ = total_time;
    return increment_;
}

std::uint64_t Writer::next_call() {
    const std::lock_guard lock(mutex_);
    return ++calls_;
}

void Writer::seal(FrameKind kind, std::uint64_t sequence, Bytes& frame) const {
    FrameHeader header;
    header.kind = kind;
    header.session = session_;
    header.sequence = sequence;
    header.size = static_cast<std::uint32_t>(frame.size() - sizeof header);
    std::memcpy(frame.data(), &header, sizeof header);
    header.checksum = checksum({frame.data(), frame.size()});
    std::memcpy(frame.data(), &header, sizeof header);
}

void Writer::write_call(FrameKind kind, std::uint64_t sequence, Bytes& frame) {
    seal(kind, sequence, frame);
    const std::lock_guard lock(mutex_);
    if (selection_.ring == 0) return put(frame.data(), frame.size());
    ring_.push_back(frame.take());
    if (ring_.size() > static_cast<std::size_t>(selection_.ring)) ring_.pop_front();
}

void Writer::flush() {
    const std::lock_guard lock(mutex_);
    for (const std::vector<std::byte>& frame : ring_) put(frame.data(), frame.size());
    ring_.clear();
}

void Writer::put(const void* data, std::size_t size) {
    if (!append(data, size)) return;
    // Two processes at once may count too little, which only makes the reader more lenient; never too much.
    constexpr off_t place = offsetof(FileHeader, complete);
    std::uint64_t complete = 0;
    if (pread(header_, &complete, sizeof complete, place) != static_cast<ssize_t>(sizeof complete)) return;
    complete += size;
    [[maybe_unused]] const ssize_t counted = pwrite(header_, &complete, sizeof complete, place);
}

bool Writer::append(const void* data, std::size_t size) {
    if (file_ < 0) return false;
    ssize_t written = 0;
    do written = ::write(file_, data, size);
    while (written < 0 && errno == EINTR);
    if (written == static_cast<ssize_t>(size)) return true;
    std::fprintf(stderr, "Lode: WARNING: LODE_RECORD: writing to %s failed (%s); the recording ends here\n",
                 file_name_.c_str(), written < 0 ? std::strerror(errno) : "the disk is full");
    close(file_);
    file_ = -1;
    return false;
}

}  // namespace lode::record

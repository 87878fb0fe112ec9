#include "finding.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace lode::host {
namespace {

class Packer {
  public:
    void add(const std::string& text) {
        add(text.size());
        bytes_ += text;
    }
    void add(std::size_t count) {
        const auto n = static_cast<std::uint64_t>(count);
        bytes_.append(reinterpret_cast<const char*>(&n), sizeof n);
    }
    void add(const std::vector<double>& values) {
        add(values.size());
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

class Unpacker {
  public:
    explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
    std::size_t count() {
        std::uint64_t n = 0;
        read(&n, sizeof n);
        return n;
    }
    std::string text() {
        std::string result(checked(count()), '\0');
        read(result.data(), result.size());
        return result;
    }
    std::vector<double> numbers() {
        std::vector<double> result(checked(count()));
        read(result.data(), result.size() * sizeof(double));
        return result;
    }

  private:
    std::size_t checked(std::size_t n) const {
        if (n > bytes_.size()) throw std::runtime_error("the answer of a check is damaged");
        return n;
    }
    void read(void* target, std::size_t size) {
        if (place_ + size > bytes_.size()) throw std::runtime_error("the answer of a check is damaged");
        std::memcpy(target, bytes_.data() + place_, size);
        place_ += size;
    }
    const std::string& bytes_;
    std::size_t place_ = 0;
};

}  // namespace

std::string_view name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::pass:
            return "pass";
        case Verdict::not_applicable:
            return "not applicable";
        case Verdict::warning:
            return "warning";
        case Verdict::fail:
            return "FAIL";
    }
    return "?";
}

Verdict CheckResult::verdict() const {
    if (findings.empty()) return applicable ? Verdict::pass : Verdict::not_applicable;
    Verdict worst = Verdict::pass;
    for (const Finding& f : findings) worst = std::max(worst, f.verdict);
    return worst;
}

bool CheckResult::has(std::string_view finding) const {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& f) { return f.name == finding; });
}

std::string packed(const CheckResult& result) {
    Packer p;
    p.add(result.check);
    p.add(result.interface);
    p.add(result.kind);
    p.add(result.applicable ? 1U : 0U);
    p.add(result.figures);
    p.add(result.findings.size());
    for (const Finding& f : result.findings) {
        p.add(static_cast<std::size_t>(f.verdict));
        p.add(f.name);
        p.add(f.details);
    }
    p.add(result.curves.size());
    for (const Curve& c : result.curves) {
        for (const std::string* text : {&c.title, &c.x_label, &c.y_label, &c.label}) p.add(*text);
        p.add(c.x);
        p.add(c.y);
    }
    return p.take();
}

CheckResult unpacked(const std::string& bytes) {
    Unpacker u(bytes);
    CheckResult result;
    result.check = u.text();
    result.interface = u.text();
    result.kind = u.text();
    result.applicable = u.count() != 0;
    result.figures = u.text();
    for (std::size_t n = u.count(); n > 0; --n) {
        const auto verdict = static_cast<Verdict>(u.count());
        std::string name = u.text();
        result.findings.push_back({verdict, std::move(name), u.text()});
    }
    for (std::size_t n = u.count(); n > 0; --n) {
        Curve c;
        for (std::string* text : {&c.title, &c.x_label, &c.y_label, &c.label}) *text = u.text();
        c.x = u.numbers();
        c.y = u.numbers();
        result.curves.push_back(std::move(c));
    }
    return result;
}

}  // namespace lode::host

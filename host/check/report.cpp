#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <unistd.h>

#include "../plot/gnuplot.hpp"
#include "../status.hpp"

namespace lode::host {
namespace {

void write_file(const std::string& path, const std::string& text) {
    std::ofstream file(path);
    file << text;
    file.close();
    if (!file) throw Failure(Status::usage, fmt::format("{}: cannot be written", path));
}

std::string verdict_word(Verdict verdict) {
    return verdict == Verdict::fail             ? "fail"
           : verdict == Verdict::not_applicable ? "not_applicable"
                                                : std::string(name_of(verdict));
}

std::string json(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') result += std::string("\\") + c;
        else if (code < 0x20) result += fmt::format("\\u{:04x}", code);
        else result += c;
    }
    return result + "\"";
}

std::string json(const std::vector<double>& values) {
    std::string result = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
        result += (i > 0 ? "," : "") + (std::isfinite(values[i]) ? fmt::format("{}", values[i]) : std::string("null"));
    return result + "]";
}

std::string html(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '<') result += "&lt;";
        else if (c == '>') result += "&gt;";
        else if (c == '&') result += "&amp;";
        else if (c == '"') result += "&quot;";
        else result += c;
    }
    return result;
}

// One figure of curves with the same title, as SVG text; empty without gnuplot.
std::string figure(const std::vector<const Curve*>& curves, const std::filesystem::path& directory) {
    const std::string stem = (directory / "figure").string();
    std::string script =
        figure_style() + fmt::format(
                             "set logscale xy\nset format x '10^{{%L}}'\nset format y '10^{{%L}}'\n"
                             "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n"
                             "set key below noenhanced\n",
                             single_quoted(curves.front()->title), single_quoted(curves.front()->x_label),
                             single_quoted(curves.front()->y_label));
    std::string plot;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        script += fmt::format("$c{} << EOD\n", i);
        for (std::size_t k = 0; k < curves[i]->x.size(); ++k)
            script += fmt::format("{} {}\n", curves[i]->x[k], curves[i]->y[k]);
        script += "EOD\n";
        plot += fmt::format("{}$c{} using 1:2 with linespoints lw 1.5 pt 7 ps 0.6 lc rgb '{}' title {}",
                            i == 0 ? "plot " : ", ", i, curve_colour(i), single_quoted(curves[i]->label));
    }
    if (!draw_script(stem, script + terminals(stem, plot)).empty()) return {};
    std::ifstream file(stem + ".svg");
    std::stringstream text;
    text << file.rdbuf();
    const std::string svg = text.str();
    const auto begin = svg.find("<svg");
    return begin == std::string::npos ? std::string() : svg.substr(begin);
}

std::string figures(const SubjectReport& report, const std::filesystem::path& directory) {
    std::map<std::string, std::vector<const Curve*>> by_title;
    for (const CheckResult& r : report.results)
        for (const Curve& c : r.curves)
            if (c.x.size() > 1) by_title[c.title].push_back(&c);
    std::string result;
    for (const auto& [title, curves] : by_title) {
        std::string svg = figure(curves, directory);
        if (svg.empty()) continue;
        // Names inside a page have to be its own.
        static int number = 0;
        const std::string prefix = fmt::format("f{}_", ++number);
        for (const char* mark : {"id='", "href='#", "url(#", "id=\"", "href=\"#"})
            for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1))
                svg.insert(at + std::string(mark).size(), prefix);
        result += "<figure>" + svg + "</figure>\n";
    }
    return result;
}

constexpr const char* style = R"(<style>
body { font: 15px/1.45 "Noto Sans", sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; width: 100%; margin: 0.5em 0 1.5em; }
th, td { text-align: left; vertical-align: top; padding: 0.3em 0.7em; border-bottom: 1px solid #e0e0e0; }
.pass { color: #2e8540; } .fail { color: #b02020; font-weight: bold; } .warning { color: #a06a00; font-weight: bold; }
.not_applicable { color: #888; } .mend { color: #444; } figure { display: inline-block; width: 46%; min-width: 26em; margin: 0.5em; }
figure svg { width: 100%; height: auto; } code { background: #f4f4f4; padding: 0 0.2em; }
</style>)";

}  // namespace

std::string text_line(const CheckResult& result) {
    std::string text = fmt::format("  {:<14} {:<22} {}\n", name_of(result.verdict()), result.check, result.figures);
    for (const Finding& f : result.findings) {
        const FindingText& about = text_of(f.name);
        text += fmt::format("    {}: {}: {}\n      {} {}\n", f.verdict == Verdict::fail ? "fail" : "warning", f.name,
                            f.details, about.meaning, about.mend);
    }
    return text;
}

std::string summary(const std::vector<SubjectReport>& reports) {
    return fmt::format("{} pass, {} not applicable, {} warning, {} fail", count(reports, Verdict::pass),
                       count(reports, Verdict::not_applicable), count(reports, Verdict::warning),
                       count(reports, Verdict::fail));
}

void write_json(const std::vector<SubjectReport>& reports, const std::string& path) {
    std::string text = fmt::format(
        "{{\"summary\": {{\"pass\": {}, \"not_applicable\": {}, \"warning\": {}, \"fail\": {}}},\n\"subjects\": [",
        count(reports, Verdict::pass), count(reports, Verdict::not_applicable), count(reports, Verdict::warning),
        count(reports, Verdict::fail));
    bool first_subject = true;
    for (const SubjectReport& s : reports) {
        text += fmt::format("{}\n {{\"material\": {}, \"kind\": {}, \"library\": {}, \"checks\": [",
                            first_subject ? "" : ",", json(s.material), json(s.kind), json(s.library));
        first_subject = false;
        bool first = true;
        for (const CheckResult& r : s.results) {
            text += fmt::format(
                "{}\n  {{\"check\": {}, \"interface\": {}, \"verdict\": {}, \"figures\": {}, \"findings\": [",
                first ? "" : ",", json(r.check), json(r.interface), json(verdict_word(r.verdict())), json(r.figures));
            first = false;
            for (std::size_t i = 0; i < r.findings.size(); ++i) {
                const Finding& f = r.findings[i];
                const FindingText& about = text_of(f.name);
                text +=
                    fmt::format("{}{{\"name\": {}, \"verdict\": {}, \"details\": {}, \"meaning\": {}, \"mend\": {}}}",
                                i > 0 ? ", " : "", json(f.name), json(verdict_word(f.verdict)), json(f.details),
                                json(std::string(about.meaning)), json(std::string(about.mend)));
            }
            text += "], \"curves\": [";
            for (std::size_t i = 0; i < r.curves.size(); ++i) {
                const Curve& c = r.curves[i];
                text += fmt::format(
                    "{}{{\"title\": {}, \"label\": {}, \"x_label\": {}, \"y_label\": {}, \"x\": {}, \"y\": {}}}",
                    i > 0 ? ", " : "", json(c.title), json(c.label), json(c.x_label), json(c.y_label), json(c.x),
                    json(c.y));
            }
            text += "]}";
        }
        text += "]}";
    }
    write_file(path, text + "]}\n");
}

void write_html(const std::vector<SubjectReport>& reports, const std::string& path) {
    const std::filesystem::path directory =
        std::filesystem::temp_directory_path() / fmt::format("lode-check-{}", getpid());
    std::filesystem::create_directories(directory);
    std::string text = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>lode check</title>{}</head><body>\n"
        "<h1>lode check</h1>\n<p>{}</p>\n",
        style, html(summary(reports)));
    for (const SubjectReport& s : reports) {
        text += fmt::format(
            "<h2>{}, {}</h2>\n<p><code>{}</code></p>\n<table><tr><th>Result</th><th>Check</th>"
            "<th>Figures and findings</th></tr>\n",
            html(s.material), html(s.kind), html(s.library));
        for (const CheckResult& r : s.results) {
            text += fmt::format("<tr><td class=\"{0}\">{1}</td><td>{2}</td><td>{3}", verdict_word(r.verdict()),
                                name_of(r.verdict()), html(r.check), html(r.figures));
            for (const Finding& f : r.findings) {
                const FindingText& about = text_of(f.name);
                text += fmt::format("<br><span class=\"{}\">{}</span>: {}<br>{} <span class=\"mend\">{}</span>",
                                    verdict_word(f.verdict), html(f.name), html(f.details),
                                    html(std::string(about.meaning)), html(std::string(about.mend)));
            }
            text += "</td></tr>\n";
        }
        text += "</table>\n" + figures(s, directory);
    }
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
    write_file(path, text + "</body></html>\n");
}

}  // namespace lode::host

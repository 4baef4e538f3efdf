// A validation report as a page.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/jobs/validate.h"

namespace patina::jobs {

namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else
            result += c;
    }
    return result;
}

// "I 2.1e-06, Q 3.0e-07, ..." of the components that were compared.
std::string largest_errors(const ValidatedCase& one, const char* separator) {
    std::string text;
    for (int c = 0; c < 4; ++c)
        if (one.largest[c] >= 0.0)
            text += fmt::format("{}{} {:.1e}", text.empty() ? "" : separator, one.components[c], one.largest[c]);
    return text;
}

std::string verdict(const ValidatedCase& one) {
    return !one.skipped.empty() ? "left out" : one.passed() ? "pass" : "FAIL";
}

struct Summary {
    int cases = 0, values = 0, skipped = 0;
};

Summary summary_of(const ValidationReport& report) {
    Summary summary;
    for (const ValidatedCase& one : report.cases) {
        if (one.skipped.empty()) {
            ++summary.cases;
            summary.values += one.count;
        } else {
            ++summary.skipped;
        }
    }
    return summary;
}

std::string sentence(const ValidationReport& report) {
    const Summary summary = summary_of(report);
    return fmt::format(
        "{} runs, {} published or exactly known values compared, {} failures; {} runs left out, each "
        "with its reason. A statistical solver is allowed five of its standard errors more.",
        summary.cases, summary.values, report.failures(), summary.skipped);
}

constexpr char about_scalar[] =
    "Intensity leaving the top of Siewert's problem IIA for unpolarized light at 53.1 deg: published, solved with all "
    "four Stokes components, and "
    "solved with the intensity alone. Ignoring polarization errs by the last column although only the intensity is "
    "looked at.";

constexpr char style[] = R"(
:root { color-scheme: light dark; --line: #d6d9de; --soft: #f4f6f8; --good: #1a7f4b; --bad: #c0392b; --text: #1d232b; --dim: #66707c; --bg: #fff; }
@media (prefers-color-scheme: dark) { :root { --line: #353c45; --soft: #1e242b; --good: #4cc38a; --bad: #ff7b6b; --text: #e4e8ed; --dim: #98a3af; --bg: #14181d; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--text); background: var(--bg); max-width: 76rem; margin: 3rem auto; padding: 0 1.5rem; }
h1 { font-weight: 650; letter-spacing: -0.02em; margin-bottom: 0.2rem; } h2 { margin-top: 2.6rem; font-weight: 600; }
p.lead { color: var(--dim); margin-top: 0; max-width: 50rem; }
.scroll { overflow-x: auto; border: 1px solid var(--line); border-radius: 10px; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; }
th, td { text-align: left; padding: 0.55rem 0.8rem; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; } thead th { background: var(--soft); font-weight: 600; white-space: nowrap; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; } td.e { font-variant-numeric: tabular-nums; white-space: nowrap; } td.e + td { min-width: 13rem; }
td:first-child:not(.n) { min-width: 18rem; }
small { color: var(--dim); display: block; } .pass { color: var(--good); font-weight: 600; } .fail { color: var(--bad); font-weight: 700; } .skip { color: var(--dim); }
.bar { display: inline-block; width: 5rem; height: 0.45rem; border-radius: 4px; background: var(--line); overflow: hidden; } .bar i { display: block; height: 100%; background: var(--good); }
)";

std::string html_row(const ValidatedCase& one) {
    const std::string name =
        fmt::format("<td>{}<small>{}</small><small>{}</small></td><td>{}</td>", escaped(one.name), escaped(one.source),
                    escaped(one.quantity), one.solver.empty() ? "&ndash;" : escaped(one.solver));
    if (!one.skipped.empty())
        return fmt::format("<tr>{}<td colspan=\"5\" class=\"skip\">left out: {}</td></tr>\n", name,
                           escaped(one.skipped));
    const double filled = std::clamp(100.0 * one.worst, 1.0, 100.0);
    return fmt::format(
        "<tr>{}<td class=\"n\">{}</td><td class=\"e\">{}</td><td>{}</td><td class=\"n\"><span class=\"bar\"><i "
        "style=\"width:{:.0f}%{}\"></i></span> {:.2g}"
        "</td><td><span class=\"{}\">{}</span><small>{:.2f} s</small></td></tr>\n",
        name, one.count, largest_errors(one, "<br>"), escaped(one.tolerance), filled,
        one.passed() ? "" : ";background:var(--bad)", one.worst, one.passed() ? "pass" : "fail", verdict(one),
        one.seconds);
}

}  // namespace

std::string to_html(const ValidationReport& report) {
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width\"><title>Patina: "
        "validation</title><style>{}</style></head><body>\n<h1>Validation</h1>\n<p class=\"lead\">{}: "
        "{}</p>\n<h2>Benchmarks</h2>\n<div class=\"scroll\"><table><thead><tr><th>case"
        "</th><th>solver</th><th>values</th><th>largest differences</th><th>allowed</th><th>difference / "
        "allowed</th><th></th></tr></thead><tbody>\n",
        style, report.software, sentence(report));
    for (const ValidatedCase& one : report.cases) page += html_row(one);
    page += fmt::format(
        "</tbody></table></div>\n<h2>What ignoring polarization costs</h2>\n<p class=\"lead\">{}</p>\n<div "
        "class=\"scroll\"><table><thead><tr><th>zenith angle</th><th>azimuth</th>"
        "<th>published</th><th>vector</th><th>scalar</th><th>vector error</th><th>scalar "
        "error</th></tr></thead><tbody>\n",
        about_scalar);
    for (const ScalarError& row : report.cost_of_ignoring_polarization)
        page += fmt::format(
            "<tr><td class=\"n\">{:.1f}&deg;</td><td class=\"n\">{:.0f}&deg;</td><td class=\"n\">{:.6f}</td><td "
            "class=\"n\">{:.6f}</td><td class=\"n\">{:.6f}</td><td "
            "class=\"n\">{:.4f} %</td><td class=\"n\">{:+.2f} %</td></tr>\n",
            row.zenith_deg, row.phi_deg, row.published, row.vector, row.scalar, std::abs(row.vector_percent()),
            row.scalar_percent());
    return page + "</tbody></table></div>\n</body></html>\n";
}

std::string to_markdown(const ValidationReport& report) {
    std::string page = fmt::format(
        "# Validation\n\nWritten by `patina validate --markdown docs/validation.md`, {}.\n\n{}\n\n## "
        "Benchmarks\n\n`ratio` is the largest difference in units of "
        "what is allowed: above 1 a case fails.\n\n| case | solver | values | largest differences | ratio | verdict "
        "|\n|---|---|---|---|---|---|\n",
        report.software, sentence(report));
    for (const ValidatedCase& one : report.cases) {
        const std::string solver = one.solver.empty() ? "" : one.solver;
        if (one.skipped.empty())
            page += fmt::format("| {} | {} | {} | {} | {:.2g} | {} |\n", one.name, solver, one.count,
                                largest_errors(one, ", "), one.worst, verdict(one));
        else
            page += fmt::format("| {} | {} | | {} | | left out |\n", one.name, solver, one.skipped);
    }
    page +=
        "\n## Sources and tolerances\n\n| case | source | what is compared | allowed difference |\n|---|---|---|---|\n";
    std::string last;
    for (const ValidatedCase& one : report.cases) {
        if (one.name != last)
            page += fmt::format("| {} | {} | {} | {} |\n", one.name, one.source, one.quantity, one.tolerance);
        last = one.name;
    }
    page += fmt::format(
        "\n## What ignoring polarization costs\n\n{}\n\n| zenith angle | azimuth | published | vector | scalar | "
        "vector error | scalar error |\n|---|---|---|---|---|---|---|\n",
        about_scalar);
    for (const ScalarError& row : report.cost_of_ignoring_polarization)
        page += fmt::format("| {:.1f}° | {:.0f}° | {:.6f} | {:.6f} | {:.6f} | {:.4f} % | {:+.2f} % |\n", row.zenith_deg,
                            row.phi_deg, row.published, row.vector, row.scalar, std::abs(row.vector_percent()),
                            row.scalar_percent());
    return page;
}

}  // namespace patina::jobs

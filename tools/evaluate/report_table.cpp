// Results as Markdown and terminal tables.
#include <algorithm>

#include <fmt/format.h>

#include "report.h"

namespace obscura::evaluate {

namespace {

std::string shotTitle(const ShotResult& shot) {
    return fmt::format("{}, camera {}, {:g} s, {} x {} px, guard band {} x {} px{}", shot.scene, shot.camera, shot.time, shot.size.x,
        shot.size.y, shot.guard.x, shot.guard.y,
        shot.every > 1 ? fmt::format(", evaluated at every {} x {} px", shot.every, shot.every) : "");
}

// A number of a row; a dash if no pixel was evaluated.
std::string number(const truth::Metrics& metrics, const char* format, float value) {
    return metrics.pixels ? fmt::format(fmt::runtime(format), value) : "-";
}
// SSIM and FLIP need neighbouring pixels: a dash with --every.
std::string perceptual(const truth::Metrics& metrics, float value) { return metrics.perceptual ? number(metrics, "{:.4f}", value) : "-"; }
// Mean absolute error, share of small errors, bias, RMSE and 99th percentile as text.
struct Numbers {
    explicit Numbers(const truth::Metrics& m)
        : eA(number(m, "{:.4f}", m.raw.eA)),
          e5(number(m, "{:.3f}", m.raw.e5)),
          bias(number(m, "{:+.4f}", m.raw.bias)),
          rmse(number(m, "{:.4f}", m.raw.rmse)),
          p99(number(m, "{:.3f}", m.raw.p99)) {}
    std::string eA, e5, bias, rmse, p99;
};

std::string secondsLine(const ShotResult& shot) {
    return fmt::format("frame {:.1f} s, references {:.1f} s{}, methods {:.1f} s, metrics {:.1f} s", shot.seconds.frame,
        shot.seconds.references, shot.referencesFromCache ? " (cached)" : "", shot.seconds.methods, shot.seconds.metrics);
}

// Rays and standard errors of the references.
std::string referenceLines(const ShotResult& shot, const char* bullet) {
    std::string text;
    for (const measure::ShotReference& reference : shot.references)
        if (reference.rays > 0.0f)
            text += fmt::format("{}{} {}: {:.0f} rays per pixel, standard error {:.4f} (means)\n", bullet, reference.kind,
                reference.falloff, reference.rays, reference.error);
    return text;
}

// Of rows that have bent normals, one line each; empty if there is none.
std::string bentLines(const ShotResult& shot, const Options& options) {
    std::string text;
    for (const Row& row : shot.rows)
        if (row.bent.pixels)
            text += fmt::format("| {} | {} | {:.2f} | {:.4f} | {:.4f} |\n", options.candidates[shot.drawn[row.drawn].candidate].label(),
                shot.references[row.reference].falloff, row.bent.degrees, row.bent.irradiance, row.bent.bentIrradiance);
    for (size_t r = 0; r < shot.references.size(); ++r)
        if (shot.bent[r].pixels)
            text += fmt::format("| normals alone | {} | {:.2f} | | |\n| the reference itself | {} | 0 | {:.4f} | {:.4f} |\n",
                shot.references[r].falloff, shot.bent[r].normalDegrees, shot.references[r].falloff, shot.bent[r].irradiance,
                shot.bent[r].bentIrradiance);
    return text.empty() ? text
                        : "| bent normals | falloff | degrees | light error, normal | light error, bent |\n|---|---|--:|--:|--:|\n" + text;
}

}  // namespace

std::string markdown(const std::vector<ShotResult>& shots, const Options& options, const About& about) {
    std::string text = fmt::format(
        "# Error of ambient-obscurance methods\n\n"
        "Errors are of visibility (1 open, 0 blocked), method minus reference, over pixels that are not sky: a positive bias is too "
        "bright. eA is the\n"
        "mean absolute error, e<5% the share of pixels within 0.05, p99 the 99th percentile. g* is the exponent on visibility that fits "
        "best, eA g* the error with it.\n"
        "Times are medians of {} frames on {}, the method's own passes; compare them only inside one table.\n",
        about.frames, about.device);
    for (const ShotResult& shot : shots) {
        text += fmt::format("\n## {}\n\n", shotTitle(shot));
        if (!shot.remark.empty()) text += shot.remark + ".\n\n";
        text +=
            "| method | preset | falloff | reference | eA | e<5% | bias | rmse | p99 | ssim | flip | g* | eA g* | ms |\n"
            "|---|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
        for (const Row& row : shot.rows) {
            const Drawn& drawn = shot.drawn[row.drawn];
            const measure::Candidate& candidate = options.candidates[drawn.candidate];
            const truth::Metrics& m = row.whole();
            const Numbers n(m);
            text += fmt::format("| {} | {}{}{} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2f} |\n", candidate.info().id,
                candidate.preset, candidate.settings.empty() ? "" : " ", fmt::join(candidate.settings, " "),
                shot.references[row.reference].falloff, shot.references[row.reference].kind, n.eA, n.e5, n.bias, n.rmse, n.p99,
                perceptual(m, m.ssim), perceptual(m, m.flipMean), number(m, "{:.2f}", m.gamma), number(m, "{:.4f}", m.adjusted.eA),
                drawn.milliseconds);
        }
        text +=
            "\n| method | preset | falloff | reference | region | pixels | eA | e<5% | bias | rmse | p99 | ssim "
            "|\n|---|---|---|---|---|--:|--:|--:|--:|--:|--:|--:|\n";
        for (const Row& row : shot.rows)
            for (size_t i = 1; i < row.regions.size(); ++i) {
                const truth::Metrics& m = row.regions[i].metrics;
                const measure::Candidate& candidate = options.candidates[shot.drawn[row.drawn].candidate];
                const Numbers n(m);
                text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", candidate.info().id,
                    candidate.preset, shot.references[row.reference].falloff, shot.references[row.reference].kind,
                    truth::kRegionNames[size_t(row.regions[i].region)], m.pixels, n.eA, n.e5, n.bias, n.rmse, n.p99, perceptual(m, m.ssim));
            }
        if (const std::string bent = bentLines(shot, options); !bent.empty()) text += "\n" + bent;
        text += "\n| method | preset | falloff | pass | ms |\n|---|---|---|---|--:|\n";
        for (const Drawn& drawn : shot.drawn) {
            const measure::Candidate& candidate = options.candidates[drawn.candidate];
            const std::string lead =
                fmt::format("| {} | {} | {} | ", candidate.info().id, candidate.preset, options.falloffs[drawn.falloff].text);
            for (const gpu::PassTime& pass : drawn.passes) text += fmt::format("{}{} | {:.3f} |\n", lead, pass.name, pass.milliseconds);
            text += fmt::format("{}**all** | {:.3f} |\n", lead, drawn.milliseconds);
        }
        text += fmt::format("\n{}- time of each stage: {}\n", referenceLines(shot, "- "), secondsLine(shot));
    }
    return text;
}

std::string textTable(const std::vector<ShotResult>& shots, const Options& options, const About& about) {
    std::string text;
    for (const ShotResult& shot : shots) {
        text += shotTitle(shot) + "\n";
        if (!shot.remark.empty()) text += "  " + shot.remark + "\n";
        size_t name = 8, kind = 9, falloff = 7;
        for (const Row& row : shot.rows) {
            name = std::max(name, options.candidates[shot.drawn[row.drawn].candidate].label().size());
            kind = std::max(kind, shot.references[row.reference].kind.size());
            falloff = std::max(falloff, shot.references[row.reference].falloff.size());
        }
        text += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>7} {:>6} {:>8} {:>7} {:>6} {:>7} {:>7} {:>8}\n", "method", name, "falloff",
            falloff, "reference", kind, "eA", "e<5%", "bias", "rmse", "p99", "ssim", "flip", "ms");
        for (const Row& row : shot.rows) {
            const Drawn& drawn = shot.drawn[row.drawn];
            const measure::ShotReference& reference = shot.references[row.reference];
            const truth::Metrics& m = row.whole();
            const Numbers n(m);
            text += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>7} {:>6} {:>8} {:>7} {:>6} {:>7} {:>7} {:8.2f}\n",
                options.candidates[drawn.candidate].label(), name, reference.falloff, falloff, reference.kind, kind, n.eA, n.e5, n.bias,
                n.rmse, n.p99, perceptual(m, m.ssim), perceptual(m, m.flipMean), drawn.milliseconds);
        }
        text += bentLines(shot, options);
        text += referenceLines(shot, "  ") + "  " + secondsLine(shot) + "\n\n";
    }
    return text + fmt::format("{}; times are medians of {} frames, the method's own passes\n", about.device, about.frames);
}

}  // namespace obscura::evaluate

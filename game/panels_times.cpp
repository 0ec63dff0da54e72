// GPU time by pass as bars, and over the last frames as a plot with its median and 95th percentile.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "panels.h"

namespace obscura::game {

namespace {

constexpr ImU32 kBar = IM_COL32(74, 127, 181, 255), kLine = IM_COL32(150, 190, 230, 255), kMedian = IM_COL32(120, 220, 120, 255),
                kP95 = IM_COL32(240, 170, 80, 255), kGround = IM_COL32(255, 255, 255, 16);

void plot(const app::Series& series, float height) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::GetContentRegionAvail().x, 32.0f);
    ImGui::Dummy({width, height});
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(from, {from.x + width, from.y + height}, kGround);
    if (series.values.size() < 2) return;
    const double median = series.median(), p95 = series.p95();
    // The scale follows the 95th percentile, so that one long frame does not flatten the plot.
    const double top = std::max(p95 * 1.4, 1e-3);
    const auto at = [&](size_t i, double value) {
        return ImVec2(
            from.x + width * float(i) / float(series.values.size() - 1), from.y + height * (1.0f - float(std::min(value / top, 1.0))));
    };
    std::vector<ImVec2> points(series.values.size());
    for (size_t i = 0; i < points.size(); ++i) points[i] = at(i, series.values[i]);
    draw->AddPolyline(points.data(), int(points.size()), kLine, 0, 1.0f);
    const size_t last = points.size() - 1;
    draw->AddLine(at(0, median), at(last, median), kMedian);
    draw->AddLine(at(0, p95), at(last, p95), kP95);
    ImGui::PushStyleColor(ImGuiCol_Text, kMedian);
    ImGui::TextUnformatted(fmt::format("median {:.3f} ms", median).c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, kP95);
    ImGui::TextUnformatted(fmt::format("95 % {:.3f} ms", p95).c_str());
    ImGui::PopStyleColor();
}

void bars(const std::vector<app::Series>& passes, std::string& chosen) {
    double longest = 1e-6;
    for (const app::Series& pass : passes) longest = std::max(longest, pass.median());
    const float height = ImGui::GetTextLineHeightWithSpacing();
    for (const app::Series& pass : passes) {
        const ImVec2 from = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        const double median = pass.median();
        ImGui::GetWindowDrawList()->AddRectFilled(from, {from.x + width * float(median / longest), from.y + height - 2.0f}, kBar);
        const std::string number = fmt::format("{:.3f}", median);
        if (ImGui::Selectable(pass.name.c_str(), chosen == pass.name)) chosen = chosen == pass.name ? std::string() : pass.name;
        const ImVec2 size = ImGui::CalcTextSize(number.c_str());
        ImGui::GetWindowDrawList()->AddText({from.x + width - size.x, from.y}, IM_COL32_WHITE, number.c_str());
    }
}

}  // namespace

void drawTimes(const Session& session) {
    static std::string chosen;  // the pass that is plotted; empty: the whole frame
    const app::Statistics& times = session.statistics;
    const double frame = times.frame().median();
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(fmt::format("frame {:.2f} ms ({:.0f}/s)  gpu {:.2f} ms  cpu {:.2f} ms", frame,
        frame > 0.0 ? 1000.0 / frame : 0.0, times.gpu().median(), times.cpu().median())
            .c_str());
    if (!session.switches.values.empty())
        ImGui::TextUnformatted(
            fmt::format("worst frame at a switch {:.1f} ms, median {:.1f} ms", session.switches.worst(), session.steady.median()).c_str());
    ImGui::PopTextWrapPos();
    const auto& passes = times.passes();
    const auto pass = std::find_if(passes.begin(), passes.end(), [](const app::Series& s) { return s.name == chosen; });
    const app::Series& shown = pass == passes.end() ? times.gpu() : *pass;
    ImGui::Text("%s, the last %zu frames", pass == passes.end() ? "gpu frame" : shown.name.c_str(), shown.values.size());
    plot(shown, ImGui::GetFontSize() * 5.0f);
    for (const app::Statistics::Spike& spike : times.spikes())
        ImGui::TextUnformatted(fmt::format(
            "spike of {:.1f} ms (median {:.1f}): {} took {:.1f} more", spike.milliseconds, spike.median, spike.cause, spike.growth)
                .c_str());
    ImGui::Separator();
    if (!session.engine.device().caps().timestamps) ImGui::TextUnformatted("no GPU times: this device has no timestamps");
    bars(passes, chosen);
}

}  // namespace obscura::game

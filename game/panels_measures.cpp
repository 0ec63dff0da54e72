// The panel of measures: noise, flicker and errors of A and B.
#include <fmt/format.h>
#include <imgui.h>

#include "panels.h"

namespace obscura::game {

namespace {

template <class Of>
void row(const Measures::Reading& reading, const char* name, const char* sentence, Of of) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    tip(sentence);
    for (const Measures::Side& side : reading.sides) {
        ImGui::TableNextColumn();
        const std::optional<float> value = of(side);
        ImGui::TextUnformatted(value ? fmt::format("{:.4f}", *value).c_str() : "-");
    }
}

}  // namespace

void drawMeasures(const Session& session) {
    const std::optional<Measures::Reading> reading = session.measures->means();
    if (!reading) return ImGui::TextUnformatted("waiting for the first frame");
    if (!reading->problem.empty()) ImGui::TextWrapped("%s", reading->problem.c_str());
    if (ImGui::BeginTable("measures", 1 + int(reading->sides.size()), ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) {
        ImGui::TableSetupColumn("in visibility, 0 to 1");
        const float width = ImGui::CalcTextSize("-0.00000").x;
        ImGui::TableSetupColumn("A", ImGuiTableColumnFlags_WidthFixed, width);
        if (reading->sides.size() > 1) ImGui::TableSetupColumn("B", ImGuiTableColumnFlags_WidthFixed, width);
        ImGui::TableHeadersRow();
        using Side = Measures::Side;
        row(*reading, "change D_A",
            "Mean change between frames along motion, over pixels whose surface is visible in both. Mean of the last 32 frames.",
            [](const Side& s) { return s.change; });
        const auto noise = [](float truth::StaticNoise::Result::* of) {
            return [of](const Side& s) { return s.noise ? std::optional<float>((*s.noise).*of) : std::nullopt; };
        };
        const char* still =
            "Standard deviation of each pixel over frames with fixed camera, world and settings: mean and 99th percentile over pixels. "
            "Starts after 32 still frames.";
        row(*reading, "static noise", still, noise(&truth::StaticNoise::Result::mean));
        row(*reading, "  P99", still, noise(&truth::StaticNoise::Result::p99));
        const auto error = [](float truth::Errors::* of) {
            return [of](const Side& s) { return s.errors ? std::optional<float>((*s.errors).*of) : std::nullopt; };
        };
        row(*reading, "error eA", "Mean absolute difference from the ray-traced reference of this frame.", error(&truth::Errors::eA));
        row(*reading, "  bias", "Mean of picture minus reference; above 0 is too bright.", error(&truth::Errors::bias));
        row(*reading, "  share < 5 %", "Fraction of pixels whose error is below 0.05.", error(&truth::Errors::e5));
        row(*reading, "excess flicker F", "Change D_A minus the change of the reference. Mean of the last 32 frames.",
            [](const Side& s) { return s.excess; });
        row(*reading, "flicker of error F_e", "Root mean square change of the error along motion. Mean of the last 32 frames.",
            [](const Side& s) { return s.flickerOfError; });
        ImGui::EndTable();
    }
    ImGui::PushTextWrapPos(0.0f);
    if (reading->stillFrames) ImGui::TextUnformatted(fmt::format("noise over {} still frames", reading->stillFrames).c_str());
    else if (reading->settling)
        ImGui::TextUnformatted(fmt::format("still for {} of {} frames", reading->settling, Measures::kSettling).c_str());
    else ImGui::TextUnformatted("noise is measured while camera and world stand still");
    if (reading->rays > 0.0f) {
        ImGui::TextUnformatted(fmt::format("reference: {:.0f} rays a pixel", reading->rays).c_str());
    } else {
        const std::string hint = session.referenceHint(*reading);
        ImGui::TextUnformatted("no reference for this frame:");
        ImGui::TextUnformatted(hint.c_str());
        if (hint.starts_with("obscura-flythrough") && ImGui::Button("Copy command")) ImGui::SetClipboardText(hint.c_str());
    }
    const double gpu = session.statistics.total("samples") + session.statistics.total("capture");
    ImGui::TextDisabled("%s",
        fmt::format("{} x {}, every {}; GPU {:.2f} ms, worker {:.1f} ms; {} frames skipped", reading->size.x, reading->size.y,
            reading->step == 1 ? "pixel" : fmt::format("{} pixels", reading->step), gpu, reading->milliseconds, session.measures->leftOut())
            .c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace obscura::game

// Comparison of two settings: the panel of side B, the divider and its labels.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "panels.h"

namespace obscura::game {

namespace {

constexpr ImU32 kLine = IM_COL32(255, 255, 255, 220), kShade = IM_COL32(0, 0, 0, 150);

std::string sideLabel(const Session& session, const char* side, const ao::Values& values) {
    const std::string text = fmt::format("{}  {}", side, label(values));
    return session.engine.device().caps().timestamps ? fmt::format("{}  {:.2f} ms", text, session.statistics.total(std::string(side) + "."))
                                                     : text;
}

}  // namespace

void drawComparison(Session& session) {
    bool on = session.comparing;
    if (ImGui::Checkbox("compare with B", &on)) session.setComparing(on);
    tip("A is left of the divider, B right of it: two methods, or one with two settings, on the same frame with the same falloff, each "
        "with its own history.");
    if (!session.comparing) return;
    ImGui::SameLine();
    if (ImGui::Button("Swap")) session.act(Action::swapSides, 0);
    ImGui::SameLine();
    if (ImGui::Button("Copy A to B")) session.act(Action::copySide, 0);
    ImGui::PushID("B");
    if (ImGui::BeginCombo("B", session.other.info().title, ImGuiComboFlags_HeightLarge)) {
        const auto methods = ao::methods();
        for (size_t i = 0; i < methods.size(); ++i)
            if (ImGui::Selectable(methods[i]->title, i == session.other.current())) session.other.select(i);
        ImGui::EndCombo();
    }
    if (ImGui::TreeNode("settings of B")) {
        drawParameters(session.other.values());
        ImGui::TreePop();
    }
    ImGui::PopID();
    ImGui::SliderFloat("divider", &session.split, 0.0f, 1.0f, "%.2f");
    ImGui::SliderFloat("difference range", &session.differenceRange, 0.005f, 1.0f, "%.3g", ImGuiSliderFlags_Logarithmic);
    tip("Difference of visibility at which the difference views saturate: to white in difference, to pale orange or pale blue in "
        "signed-difference.");
}

void drawDivider(const Session& session) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    // Difference views have no divider, but keep the labels: orange means that A is lighter.
    const bool sides = !render::isDifference(session.view) && session.view != render::View::pass;
    const float x = sides ? std::round(session.split * size.x) : std::round(0.5f * size.x);
    if (sides) {
        draw->AddLine({x, 0.0f}, {x, size.y}, kShade, 3.0f);
        draw->AddLine({x, 0.0f}, {x, size.y}, kLine, 1.0f);
        draw->AddCircleFilled({x, 0.5f * size.y}, 6.0f, kLine);
        if (!ImGui::GetIO().WantCaptureMouse && std::fabs(ImGui::GetIO().MousePos.x - x) <= 8.0f)
            ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    }
    const float margin = ImGui::GetFontSize() * 0.5f, line = ImGui::GetTextLineHeight();
    const float y = size.y - line - 2.0f * margin;
    const auto text = [&](const std::string& words, bool left) {
        const float width = ImGui::CalcTextSize(words.c_str()).x;
        const float at = left ? x - 2.0f * margin - width : x + 2.0f * margin;
        draw->AddRectFilled({at - margin, y - margin * 0.5f}, {at + width + margin, y + line + margin * 0.5f}, kShade, 3.0f);
        draw->AddText({at, y}, kLine, words.c_str());
    };
    text(sideLabel(session, "A", session.choice.values()), true);
    text(sideLabel(session, "B", session.other.values()), false);
}

}  // namespace obscura::game

// The main panel, the key list and notices. Menu entries, presets and sliders of methods are generated from the registry.
#include "panels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <imgui.h>

#include "app/voxel_arguments.h"
#include "report.h"

namespace obscura::game {

void tip(const char* sentence) {
    if (!*sentence || !ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28.0f);
    ImGui::TextUnformatted(sentence);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

namespace {

// Which group of the menu a method stands in.
enum class Group { papers, own, baselines, off };
constexpr std::pair<Group, const char*> kGroups[] = {
    {Group::own, "our own"}, {Group::papers, "of the papers"}, {Group::baselines, "baselines"}, {Group::off, "off"}};

Group groupOf(const ao::MethodInfo& info) {
    if (!info.needs) return Group::off;
    if (info.baseline) return Group::baselines;
    return *info.paper ? Group::papers : Group::own;
}

// What the menu says of a method's cost: measured here, or by its cycles from that of the present method.
std::string costText(const Session& session, size_t method) {
    if (session.costs[method] > 0.0) return fmt::format("{:.2f}", session.costs[method]);
    const size_t present = session.choice.current();
    const auto cyclesOf = [&](size_t i) {
        const ao::Values& values = session.choice.valuesOf(i);
        const ao::Preset* preset = presetsOf(values).preset;
        const auto figures = preset ? session.figures.of(values.info().id, preset->id) : std::nullopt;
        return figures ? figures->cycles.value_or(0.0) : 0.0;
    };
    const double from = cyclesOf(present), to = cyclesOf(method);
    if (!ao::methods()[method]->needs || from == 0.0 || to == 0.0 || session.costs[present] == 0.0) return "";
    return fmt::format("~{:.2f}", session.costs[present] * to / from);
}

void methodRow(Session& session, size_t i) {
    const ao::MethodInfo& info = *ao::methods()[i];
    const ao::Values& values = session.choice.valuesOf(i);
    const ao::Preset* preset = presetsOf(values).preset;
    const auto figures = preset ? session.figures.of(info.id, preset->id) : std::nullopt;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string name = fmt::format("{}  {}", i < 9 ? std::to_string(i + 1) : std::string(" "), info.id);
    if (ImGui::Selectable(name.c_str(), i == session.choice.current(), ImGuiSelectableFlags_SpanAllColumns)) session.selectMethod(i);
    tip(fmt::format("{}. {}{}{}", info.title, info.sentence, *info.paper ? "\n\n" : "", info.paper).c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(costText(session, i).c_str());
    ImGui::TableNextColumn();
    if (figures) ImGui::TextUnformatted(fmt::format("{:.3f}", figures->eA).c_str());
}

void methodMenu(Session& session) {
    if (session.recommendation) {
        if (ImGui::Selectable(fmt::format("Recommended: {}", label(*session.recommended())).c_str(), session.usesRecommendation()))
            session.useRecommendation(*session.recommendation);
        tip("The most accurate setting whose time, measured at the start, is within the budget (--budget).");
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped("%s", session.recommendation->reason().c_str());
        ImGui::PopStyleColor();
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    if (ImGui::BeginTable(
            "methods", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter, {-1.0f, line * 12.0f})) {
        ImGui::TableSetupScrollFreeze(0, 1);
        ImGui::TableSetupColumn("method");
        const float width = ImGui::CalcTextSize("~000.00").x;
        ImGui::TableSetupColumn("GPU ms", ImGuiTableColumnFlags_WidthFixed, width);
        ImGui::TableSetupColumn("error", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("error").x);
        ImGui::TableHeadersRow();
        for (const auto& [group, name] : kGroups) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", name);
            for (size_t i = 0; i < ao::methods().size(); ++i)
                if (groupOf(*ao::methods()[i]) == group) methodRow(session, i);
        }
        ImGui::EndTable();
    }
    tip("GPU ms: of the method's passes when it was last shown; ~: from the present method's by cycles on a Radeon RX 6900 XT. error: mean "
        "absolute error of visibility against ray tracing, in the toasters and the atrium.");
    ImGui::TextWrapped("%s", session.choice.info().sentence);
}

}  // namespace

void drawParameters(ao::Values& values) {
    static ImGuiTextFilter search;
    const ao::MethodInfo& info = values.info();
    const ao::Preset* current = presetsOf(values).preset;
    if (info.presets.size() > 0 && ImGui::BeginCombo("preset", current ? current->id : "(own)")) {
        for (const ao::Preset& preset : info.presets) {
            if (ImGui::Selectable(preset.id, &preset == current)) usePreset(values, preset);
            tip(preset.sentence);
        }
        ImGui::EndCombo();
    }
    const ao::Preset* resolved = info.needs ? resolveOf(values) : nullptr;
    if (info.needs && ImGui::BeginCombo("resolve", resolved ? resolved->id : "(own)")) {
        for (const ao::Preset& preset : ao::resolvePresets()) {
            if (ImGui::Selectable(preset.id, &preset == resolved)) resolve(values, preset);
            tip(preset.sentence);
        }
        ImGui::EndCombo();
    }
    if (info.parameters.size() > 0) search.Draw("search", -ImGui::CalcTextSize("search").x - ImGui::GetStyle().ItemInnerSpacing.x);
    tip("Shows the parameters whose name or description contains this.");
    for (const ao::Parameter& parameter : info.parameters) {
        if (!search.PassFilter(parameter.id) && !search.PassFilter(parameter.sentence)) continue;
        float value = values[parameter.id];
        const std::string label = *parameter.unit ? fmt::format("{} [{}]", parameter.id, parameter.unit) : parameter.id;
        if (parameter.choices.size() > 0) {
            int index = std::clamp(int(value + 0.5f), 0, int(parameter.choices.size()) - 1);
            if (ImGui::Combo(label.c_str(), &index, parameter.choices.items, int(parameter.choices.size())))
                values.set(parameter.id, float(index));
        } else if (parameter.integer && parameter.minimum == 0.0f && parameter.maximum == 1.0f) {
            bool on = value > 0.5f;
            if (ImGui::Checkbox(label.c_str(), &on)) values.set(parameter.id, on ? 1.0f : 0.0f);
        } else if (parameter.integer) {
            int whole = int(value + (value < 0.0f ? -0.5f : 0.5f));
            if (ImGui::SliderInt(label.c_str(), &whole, int(parameter.minimum), int(parameter.maximum)))
                values.set(parameter.id, float(whole));
        } else {
            // Ranges over several powers of ten need a logarithmic slider.
            const float least = parameter.minimum > 0.0f ? parameter.minimum : parameter.initial;
            const bool wide = least > 0.0f && parameter.maximum / least > 50.0f;
            if (ImGui::SliderFloat(
                    label.c_str(), &value, parameter.minimum, parameter.maximum, "%.4g", wide ? ImGuiSliderFlags_Logarithmic : 0))
                values.set(parameter.id, value);
        }
        tip(parameter.sentence);
    }
}

namespace {

void falloffPanel(ao::Falloff& falloff) {
    int kind = int(falloff.kind);
    if (ImGui::Combo("falloff", &kind, ao::falloffKinds().items, int(ao::falloffKinds().size()))) {
        falloff.kind = ao::FalloffKind(kind);
        if (falloff.kind == ao::FalloffKind::ramp) falloff.end = std::max(falloff.end, falloff.length * 2.0f);
    }
    tip("Weight of an occluder by its distance: 1 at the surface, decreasing with distance.");
    const bool ramp = falloff.kind == ao::FalloffKind::ramp;
    ImGui::SliderFloat(ramp ? "1 up to [m]" : "length [m]", &falloff.length, 0.01f, 20.0f, "%.3g", ImGuiSliderFlags_Logarithmic);
    falloff.length = std::max(falloff.length, 1e-3f);
    if (!ramp) return;
    ImGui::SliderFloat("0 from [m]", &falloff.end, 0.02f, 40.0f, "%.3g", ImGuiSliderFlags_Logarithmic);
    falloff.end = std::max(falloff.end, falloff.length * 1.001f);
}

void viewPanel(Session& session) {
    const std::string current = session.view == render::View::pass ? "pass:" + session.passView : render::name(session.view);
    if (ImGui::BeginCombo("view", current.c_str(), ImGuiComboFlags_HeightLarge)) {
        for (const render::View view : render::kViews)
            if (ImGui::Selectable(render::name(view), view == session.view)) {
                session.view = view;
                if (render::isDifference(view)) session.setComparing(true);
            }
        ImGui::Separator();
        for (const std::string& name : session.passNames)
            if (ImGui::Selectable(("pass:" + name).c_str(), session.view == render::View::pass && name == session.passView)) {
                session.view = render::View::pass;
                session.passView = name;
            }
        ImGui::EndCombo();
    }
    tip("Shows the picture, a buffer of the frame, or the output of any pass.");
    ImGui::Checkbox("bent normals", &session.bentNormals);
    tip("Takes ambient light from bent normals and blocks reflections by their cone, where the method has them.");
    bool smooth = session.antialiasing != render::Antialiasing::none;
    if (ImGui::Checkbox("anti-aliasing", &smooth))
        session.antialiasing = smooth ? render::Antialiasing::temporal : render::Antialiasing::none;
    tip("Jitters the final picture and averages it over frames. Other views and measured frames are not jittered.");
    ImGui::SliderFloat("exposure", &session.exposure, 0.05f, 20.0f, "%.3g", ImGuiSliderFlags_Logarithmic);
    ImGui::SliderFloat("guard band", &session.guard, 0.0f, 0.5f, "%.2f");
    tip("Renders buffers beyond the picture by this fraction of each side, so that occluders outside it count. Costs the time of the extra "
        "pixels; at 0 occlusion is missing along the borders.");
}

bool wantsVoxels(const Session& session) {
    return ((ao::needs(session.choice.values()) | (session.comparing ? ao::needs(session.other.values()) : 0)) & ao::kVolume) ||
           render::isVoxels(session.view);
}

void voxelPanel(Session& session) {
    render::Voxelization& voxels = session.voxels;
    if (session.view == render::View::voxelSlice) {
        render::VoxelSlice& slice = session.slice;
        ImGui::Combo("slice axis", &slice.axis, "x\000y\000z\0");
        bool atEye = !slice.at;
        float at = slice.at.value_or(session.camera().eye[slice.axis]);
        if (ImGui::SliderFloat("slice at [m]", &at, session.stage.bounds.min[slice.axis], session.stage.bounds.max[slice.axis], "%.2f"))
            slice.at = at;
        else if (ImGui::Checkbox("at the camera", &atEye)) slice.at = atEye ? std::nullopt : std::optional(at);
    }
    int voxelizer = int(voxels.voxelizer), shell = int(voxels.shell), side = std::countr_zero(voxels.cells) - 6;
    if (ImGui::Combo("voxelizer", &voxelizer, app::kVoxelizerNames, int(std::size(app::kVoxelizerNames))))
        voxels.voxelizer = render::Voxelizer(voxelizer);
    tip("openvdb: a worker thread voxelizes static geometry once, and objects again when they move. gpu: everything is voxelized every "
        "frame.");
    int structure = int(voxels.structure);
    if (ImGui::Combo("voxel structure", &structure, app::kStructureNames, int(std::size(app::kStructureNames))))
        voxels.structure = ao::VolumeStructure(structure);
    tip("dense: cubes of bits around the camera. nanovdb: the same cells as a sparse grid, built by OpenVDB: less memory, slower to "
        "trace.");
    if (ImGui::Combo("voxel shell", &shell, app::kShellNames, int(std::size(app::kShellNames)))) voxels.shell = voxel::Shell(shell);
    tip("conservative: every cell that a surface touches. thin: the fewest cells that no path across cell faces passes; short rays miss "
        "some surfaces.");
    if (ImGui::Combo("voxels per side", &side, "64\000128\000256\000512\0")) voxels.cells = 64u << side;
    tip("Cells per side of each level of voxels. Memory grows with its cube; few are large cells, which darken open places.");
    int levels = int(voxels.levels);
    if (ImGui::SliderInt("voxel levels", &levels, 1, int(voxel::kMostLevels))) voxels.levels = uint32_t(levels);
    tip("Each level is twice as wide as the one before, with cells twice as large. Nothing beyond the last one occludes.");
}

// What of the scene's animations plays.
void animationMenu(scene::Instance& scene) {
    const std::vector<scene::Animation>& list = scene.model->animations;
    if (list.size() < 2) return;
    const auto nameOf = [&](int i) {
        if (i < 0) return std::string(i == scene::kRestPose ? "none" : "all");
        return list[size_t(i)].name.empty() ? fmt::format("animation {}", i) : list[size_t(i)].name;
    };
    if (ImGui::BeginCombo("animation", nameOf(scene.animation).c_str())) {
        for (int i = scene::kAllAnimations; i < int(list.size()); ++i) {
            ImGui::PushID(i);
            if (ImGui::Selectable(nameOf(i).c_str(), i == scene.animation)) scene.animation = i;
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    tip("all: those that move different nodes play together. none: the rest pose.");
}

void timePanel(Session& session) {
    if (ImGui::Button(session.paused ? "Resume" : "Pause")) session.act(Action::pause, 0);
    ImGui::SameLine();
    if (ImGui::Button("<")) session.act(Action::stepBack, 0);
    ImGui::SameLine();
    if (ImGui::Button(">")) session.act(Action::stepForward, 0);
    ImGui::SameLine();
    bool following = session.following;
    if (ImGui::Checkbox("flythrough", &following)) session.act(Action::toggleFlythrough, 0);
    ImGui::SameLine();
    if (ImGui::Checkbox("walk", &session.player.walking)) session.follow(false);
    const float end = std::max({session.stage.world.duration(), session.stage.path.duration, 1.0f});
    float shown = std::fmod(session.time, end);
    if (ImGui::SliderFloat("time [s]", &shown, 0.0f, end, "%.2f")) session.scrub(shown);
    tip("World time; drag to scrub. Animations and flythrough restart at the end.");
    animationMenu(session.stage.world.instances().front());
    ImGui::SliderFloat("time scale", &session.pace, 0.125f, 8.0f, "x %.3g", ImGuiSliderFlags_Logarithmic);
    if (ImGui::Button(session.recorder.running() ? "Stop recording" : "Record")) session.act(Action::record, 0);
    tip("Writes the camera path to a file in the current folder.");
    ImGui::SameLine();
    if (ImGui::Button(session.replaying() ? "Stop replay" : "Replay")) session.act(Action::replay, 0);
    tip("Replays the last recorded path in steps of 1/30 s of world time, so that every replay draws the same frames.");
    ImGui::SameLine();
    ImGui::TextUnformatted(
        session.recorder.running() ? fmt::format("{:.1f} s", session.recorder.seconds()).c_str() : session.replayFile.filename().c_str());
    if (ImGui::Button("Drop a toaster")) session.act(Action::dropToy, 0);
    ImGui::SameLine();
    if (ImGui::Button("Remove one")) session.act(Action::removeToy, 0);
    ImGui::SameLine();
    ImGui::Text("%zu / %zu", session.stage.toys->dropped(), Toys::kMost);
}

void factsPanel(Session& session) {
    ImGui::PushTextWrapPos(0.0f);
    const render::SceneFacts facts = session.engine.renderer().facts();
    const double mebi = 1.0 / (1024.0 * 1024.0);
    const scene::Camera camera = session.camera();
    ImGui::TextUnformatted(fmt::format("{}\n{} triangles, {} drawn in {} draws\n{} instances", session.stage.info.title, facts.triangles,
        facts.drawn, facts.draws, facts.instances)
            .c_str());
    ImGui::TextUnformatted(fmt::format("memory {:.1f} MiB: frame {:.1f}, textures {:.1f}, geometry {:.1f}",
        double(session.engine.device().memoryUse()) * mebi, double(session.engine.frames().executor().poolBytes()) * mebi,
        double(facts.textureBytes) * mebi, double(facts.geometryBytes) * mebi)
            .c_str());
    if (const voxel::Voxels* voxels = session.engine.renderer().voxels(); voxels && wantsVoxels(session))
        ImGui::TextUnformatted(voxelFacts(*voxels, session.statistics).c_str());
    ImGui::TextUnformatted(fmt::format("eye {:.2f} {:.2f} {:.2f}", camera.eye.x, camera.eye.y, camera.eye.z).c_str());
    ImGui::TextUnformatted(session.engine.device().caps().deviceName.c_str());
    ImGui::PopTextWrapPos();
}

void errorPanel(const std::vector<std::string>& errors) {
    if (errors.empty()) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x * 0.5f, size.y - 12.0f}, ImGuiCond_Always, {0.5f, 1.0f});
    ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {size.x * 0.9f, size.y * 0.4f});
    if (ImGui::Begin("Shader errors: the last valid program stays in use", nullptr,
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing)) {
        ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.55f, 0.45f, 1.0f});
        for (const std::string& error : errors) ImGui::TextUnformatted(error.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::End();
}

void noticeLine(const Session& session) {
    if (session.notice.empty() || app::now() > session.noticeUntil) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    // Of the text's size: an automatic size follows a frame late.
    const ImVec2 text = ImGui::CalcTextSize(session.notice.c_str()), padding = ImGui::GetStyle().WindowPadding;
    ImGui::SetNextWindowPos({size.x * 0.5f, 12.0f}, ImGuiCond_Always, {0.5f, 0.0f});
    ImGui::SetNextWindowSize({text.x + 2.0f * padding.x, text.y + 2.0f * padding.y});
    constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing;
    if (ImGui::Begin("##notice", nullptr, kPlain)) ImGui::TextUnformatted(session.notice.c_str());
    ImGui::End();
}

// Panels return to their default place when the window is resized; otherwise they stay where the user put them.
ImGuiCond placing() {
    static ImVec2 last{0.0f, 0.0f};
    static int frame = -1;
    static ImGuiCond condition = ImGuiCond_Always;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (frame != ImGui::GetFrameCount()) {
        condition = size.x != last.x || size.y != last.y ? ImGuiCond_Always : ImGuiCond_FirstUseEver;
        frame = ImGui::GetFrameCount();
        last = size;
    }
    return condition;
}

float panelWidth() { return std::min(ImGui::GetFontSize() * 25.0f, ImGui::GetIO().DisplaySize.x * 0.42f); }

void drawMain(Session& session) {
    ImGui::SetNextWindowPos({8.0f, 8.0f}, placing());
    ImGui::SetNextWindowSize({panelWidth(), ImGui::GetIO().DisplaySize.y - 16.0f}, placing());
    if (ImGui::Begin("Obscura")) {
        ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.58f);
        methodMenu(session);
        drawParameters(session.choice.values());
        ImGui::Separator();
        drawComparison(session);
        ImGui::Separator();
        falloffPanel(session.choice.falloff);
        ImGui::Separator();
        viewPanel(session);
        if (wantsVoxels(session)) voxelPanel(session);
        ImGui::Separator();
        timePanel(session);
        ImGui::Separator();
        bool measuring = session.measures != nullptr;
        if (ImGui::Checkbox("measure", &measuring)) session.act(Action::measure, 0);
        tip("Measures noise, flicker and errors of the picture on every n-th pixel of each frame.");
        ImGui::SameLine();
        if (ImGui::Button("Copy command")) session.act(Action::copyCommand, 0);
        tip("Copies the command that starts the game with this frame: scene, camera, time, method, settings.");
        factsPanel(session);
        ImGui::TextDisabled("F1: keys   Tab: hide panels");
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

void drawTimesWindow(const Session& session) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - panelWidth() - 8.0f, 8.0f}, placing());
    ImGui::SetNextWindowSize({panelWidth(), std::min(size.y * 0.55f, ImGui::GetFontSize() * 36.0f)}, placing());
    if (ImGui::Begin("Times")) drawTimes(session);
    ImGui::End();
    if (!session.measures) return;
    ImGui::SetNextWindowPos({size.x - panelWidth() - 8.0f, size.y * 0.55f + 12.0f}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({panelWidth(), size.y * 0.45f - 20.0f}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Measures")) drawMeasures(session);
    ImGui::End();
}

}  // namespace

void drawKeys() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x * 0.5f, size.y * 0.5f}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.97f);
    ImGui::SetNextWindowFocus();  // above the panels
    if (ImGui::Begin("Keys", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse))
        ImGui::TextUnformatted(keyPage(false).c_str());
    ImGui::End();
}

void drawPanels(Session& session) {
    if (session.comparing) drawDivider(session);
    noticeLine(session);
    errorPanel(session.engine.shaders().errors());
    if (session.showOverlay) {
        drawMain(session);
        drawTimesWindow(session);
    }
    if (session.showKeys) drawKeys();
}

}  // namespace obscura::game

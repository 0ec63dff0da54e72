#include "bench.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/progress.h"
#include "balls.h"
#include "measure/draw.h"
#include "measure/references.h"
#include "scene/hash.h"
#include "scene/json_text.h"

namespace obscura::bench {

namespace fs = std::filesystem;

namespace {

constexpr uint32_t kMeasure = 2;  // version of the measurement; saved measurements of other versions are not resumed

constexpr double kFlickerStart = 4.0;  // s into the scene's flythrough, where the camera moves

// A row being measured, with the times of every timed frame of every round.
struct Cell {
    Row row;
    size_t shot = 0;
    const measure::FalloffChoice* falloff = nullptr;
    const measure::Candidate* candidate = nullptr;
    std::vector<app::Series> passes;
    std::vector<double> own, rest;

    void add(const measure::Drawing& drawing) {
        for (const app::Series& pass : drawing.passes) {
            std::vector<double>& values = app::named(passes, pass.name).values;
            values.insert(values.end(), pass.values.begin(), pass.values.end());
        }
        own.insert(own.end(), drawing.own.begin(), drawing.own.end());
        rest.insert(rest.end(), drawing.rest.begin(), drawing.rest.end());
        row.rounds.push_back(app::percentile(drawing.own, 0.5));
    }
    Row finished() const {
        Row result = row;
        result.median = app::percentile(own, 0.5);
        result.p95 = app::percentile(own, 0.95);
        result.frame = app::percentile(rest, 0.5);
        result.passes.clear();
        for (const app::Series& pass : passes) result.passes.push_back({pass.name, pass.median(), pass.p95()});
        return result;
    }
};

// All shots of a scene. Their cells are measured in turns, round by round.
class SceneBench {
public:
    SceneBench(measure::Machine& machine, const Options& options, const app::SceneFile& scene, const std::string& title)
        : m_machine(machine), m_options(options), m_title(title), m_scene(scene), m_loaded(machine, scene, options.what.animation) {
        for (const measure::CameraChoice& camera : options.what.cameras)
            for (const glm::uvec2 size : options.sizes) {
                measure::Measurement sized = options.what;
                sized.size = size;
                m_shots.push_back(std::move(*m_loaded.shot(sized, camera)));
            }
        for (size_t shot = 0; shot < m_shots.size(); ++shot)
            for (const measure::FalloffChoice& falloff : options.what.falloffs)
                for (const measure::Candidate& candidate : options.what.candidates) m_cells.push_back(cellOf(shot, falloff, candidate));
        std::string file = scene.info.name;
        for (char& c : file)
            if (!std::isalnum((unsigned char)c) && c != '-') c = '_';
        if (file != scene.info.name) file += "-" + scene::Hash().add(scene.info.name).hex().substr(0, 8);
        m_file = options.out / "parts" / (file + ".json");
        m_key = key();
        if (!options.again) take();
    }

    std::vector<Row> measure() {
        for (const measure::FalloffChoice& falloff : m_options.what.falloffs)
            for (const measure::Candidate& candidate : m_options.what.candidates)
                m_machine.expectMethod(*m_shots.front().library, candidate.info(), falloff.falloff.kind);
        const uint32_t rounds = m_options.what.rounds;
        size_t done = 0, left = 0;
        for (const Cell& cell : m_cells) left += rounds - cell.row.rounds.size();
        const std::vector<Ground> grounds = std::any_of(m_cells.begin(), m_cells.end(), [](const Cell& c) { return c.row.rounds.empty(); })
                                                ? look()
                                                : std::vector<Ground>();
        {
            app::Progress progress("timing " + m_title, left);
            for (uint32_t round = 0; round < rounds; ++round)
                for (Cell& cell : m_cells) {
                    if (cell.row.rounds.size() > round) continue;
                    progress.at(done++, cell.row.label());
                    const measure::Drawing drawing = measure::draw(m_machine, m_shots[cell.shot], *cell.candidate, cell.falloff->falloff,
                        m_options.what.warmUp, m_options.what.frames);
                    if (round == 0) judge(cell, drawing, grounds[cell.shot]);
                    cell.add(drawing);
                    save(done == left);
                }
        }
        if (m_options.flicker) flicker();
        std::vector<Row> rows;
        for (const Cell& cell : m_cells) rows.push_back(cell.finished());
        return rows;
    }

private:
    Cell cellOf(size_t shot, const measure::FalloffChoice& falloff, const measure::Candidate& candidate) const {
        Cell cell;
        cell.shot = shot;
        cell.falloff = &falloff;
        cell.candidate = &candidate;
        Row& row = cell.row;
        row.scene = m_shots[shot].scene;
        row.camera = m_shots[shot].camera;
        row.falloff = falloff.text;
        row.method = candidate.info().id;
        row.preset = candidate.preset;
        row.settings = fmt::format("{}", fmt::join(candidate.settings, " "));
        row.width = m_shots[shot].frame.visible().x;
        row.height = m_shots[shot].frame.visible().y;
        row.baseline = candidate.info().baseline;
        row.triangles = m_loaded.triangles();
        row.reach = ao::reach(falloff.falloff);
        row.varied = fmt::format("{}", fmt::join(candidate.varied, " "));
        for (const std::string& name : candidate.varied)
            if (candidate.values.has(name.c_str())) row.samples = std::max(row.samples, 1.0) * double(candidate.values[name.c_str()]);
        return cell;
    }

    std::string key() const {
        scene::Hash hash;
        const measure::Measurement& what = m_options.what;
        hash.add(kMeasure)
            .add(m_machine.deviceName())
            .add(what.frames)
            .add(what.warmUp)
            .add(what.guard)
            .add(what.rays.rays)
            .add(what.rays.seed);
        hash.add(int(what.reference.world)).add(int(what.reference.screen)).add(m_loaded.triangles()).add(what.animation);
        for (const Cell& cell : m_cells) {
            hash.add(cell.row.name())
                .add(what.voxels.cells)
                .add(what.voxels.cellSize)
                .add(int(what.voxels.voxelizer))
                .add(int(what.voxels.structure));
            for (const float value : cell.candidate->values.values()) hash.add(value);
        }
        for (const measure::Shot& shot : m_shots) hash.add(shot.frame.depth.data(), shot.frame.depth.size() * sizeof(float));
        if (const auto& f = m_options.flicker) hash.add(f->size.x).add(f->size.y).add(f->length);
        for (const gpu::EmbeddedShader& shader : ao::shaders()) hash.add(shader.spirv.data(), shader.spirv.size_bytes());
        return hash.hex();
    }

    // References and baseline memory of a shot's cells.
    struct Ground {
        uint64_t bytes;  // of the frame without obscurance
        std::vector<measure::ShotReference> references;
    };
    std::vector<Ground> look() {
        std::vector<Ground> grounds;
        for (measure::Shot& shot : m_shots) {
            const measure::Candidate nothing{ao::Values(*ao::methods()[0]), "default", {}};
            const uint64_t bytes = measure::draw(m_machine, shot, nothing, m_options.what.falloffs.front().falloff, 1, 1).bytes;
            grounds.push_back({bytes, referencesOf(m_machine, shot, m_options.what).list});
        }
        return grounds;
    }

    // Errors and memory, which are the same in every round.
    void judge(Cell& cell, const measure::Drawing& drawing, const Ground& ground) const {
        cell.row.bytes = drawing.bytes - std::min(drawing.bytes, ground.bytes);
        for (const measure::ShotReference& reference : ground.references) {
            if (reference.falloff != cell.falloff->text) continue;
            const truth::Metrics m = truth::compare(drawing.visibility, reference.visibility, m_shots[cell.shot].frame.visibleMask());
            if (m.pixels) cell.row.errors.push_back({reference.kind, m.raw.eA, m.raw.bias, m.raw.rmse, m.raw.p99, m.ssim});
        }
    }

    // Flicker over the scene's flythrough, if it has one; the same for all cameras and sizes.
    void flicker() {
        if (!m_scene.flythrough || std::all_of(m_cells.begin(), m_cells.end(), [](const Cell& c) { return c.row.flicker.has_value(); }))
            return;
        for (const measure::FalloffChoice& falloff : m_options.what.falloffs) {
            flythrough::Settings settings = *m_options.flicker;
            settings.falloff = falloff;
            flythrough::Flight flight(
                m_machine, flythrough::findScript(fmt::format("{}@{:g}", m_scene.flythrough->string(), kFlickerStart)), settings);
            for (const measure::Candidate& candidate : m_options.what.candidates) {
                std::optional<Flicker> found;
                for (Cell& cell : m_cells) {
                    if (cell.candidate != &candidate || cell.falloff->text != falloff.text || cell.row.flicker) continue;
                    if (!found) {
                        const flythrough::Summary summary = summarize(flight.measure(candidate, flythrough::ownFilter(candidate)));
                        if (summary.frames == 0) break;  // the flythrough shows only sky
                        found = Flicker{summary.flickerOfError, summary.referenceFlicker};
                    }
                    cell.row.flicker = found;
                }
                if (found) save(true);
            }
        }
    }

    // At most every 2 s unless forced.
    void save(bool must) {
        constexpr double kEvery = 2000.0;  // ms
        if (!must && app::now() - m_saved < kEvery) return;
        m_saved = app::now();
        Json json{{"key", m_key}, {"cells", Json::array()}};
        for (const Cell& cell : m_cells) {
            Json line = toJson(cell.row);
            line["own"] = cell.own;
            line["rest"] = cell.rest;
            for (const app::Series& pass : cell.passes) line["times"].push_back({{"name", pass.name}, {"values", pass.values}});
            json["cells"].push_back(std::move(line));
        }
        app::writeFile(m_file, scene::dump(json) + "\n");
    }

    // Loads the measurements of an earlier run with the same key and at most as many rounds.
    void take() {
        std::ifstream in(m_file, std::ios::binary);
        if (!in) return;
        try {
            const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
            if (json.at("key") != m_key || json.at("cells").size() != m_cells.size()) return;
            std::vector<Cell> cells = m_cells;
            for (size_t i = 0; i < cells.size(); ++i) {
                const Json& line = json["cells"][i];
                cells[i].row = rowOf(line);
                cells[i].own = line.at("own").get<std::vector<double>>();
                cells[i].rest = line.at("rest").get<std::vector<double>>();
                if (line.contains("times"))
                    for (const Json& pass : line["times"])
                        cells[i].passes.push_back({pass.at("name"), pass.at("values").get<std::vector<double>>()});
                if (cells[i].row.rounds.size() > m_options.what.rounds) return;
            }
            m_cells = std::move(cells);
        } catch (const Json::exception&) {}  // not a file of this program: measure again
    }

    measure::Machine& m_machine;
    const Options& m_options;
    std::string m_title;
    app::SceneFile m_scene;
    measure::LoadedScene m_loaded;
    std::vector<measure::Shot> m_shots;
    std::vector<Cell> m_cells;
    fs::path m_file;
    std::string m_key;
    double m_saved = 0.0;
};

}  // namespace

Results measure(const Options& options, measure::Machine& machine) {
    const measure::Measurement& what = options.what;
    app::expectFolder(options.out / "parts");
    std::vector<std::string> names = what.scenes;
    if (!options.triangles.empty()) app::expectFolder(options.out / "scenes");
    for (const uint64_t triangles : options.triangles) names.push_back(writeBalls(triangles, options.out / "scenes").string());

    const std::vector<app::SceneFile> scenes = app::expectScenes(names);
    Results results;
    results.device = machine.deviceName();
    results.command = options.command;
    results.guard = what.guard;
    results.frames = what.frames, results.warmUp = what.warmUp, results.rounds = what.rounds, results.rays = what.rays.rays;
    if (options.flicker)
        results.flickerFrames = options.flicker->length, results.flickerWidth = options.flicker->size.x,
        results.flickerHeight = options.flicker->size.y;
    for (size_t i = 0; i < scenes.size(); ++i) {
        const std::string title = fmt::format("{} ({}/{})", scenes[i].info.name, i + 1, scenes.size());
        const std::vector<Row> rows = SceneBench(machine, options, scenes[i], title).measure();
        results.rows.insert(results.rows.end(), rows.begin(), rows.end());
    }
    return results;
}

}  // namespace obscura::bench

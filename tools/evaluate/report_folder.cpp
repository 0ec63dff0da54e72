// The folder of results: EXR, PNG, metrics.json, metrics.md.
#include <cctype>
#include <set>

#include <fmt/format.h>

#include "app/files.h"
#include "measure/false_colour.h"
#include "report.h"
#include "scene/json_text.h"

namespace obscura::evaluate {

namespace fs = std::filesystem;

namespace {

truth::Picture one(const char* channel, const truth::Plane& plane) {
    truth::Picture picture;
    picture.add(channel, plane);
    return picture;
}

// The evaluated pixels only: with --every, pictures of references and errors are smaller than the frame.
truth::Plane evaluatedPixels(const truth::Plane& plane, uint32_t every) {
    if (every <= 1) return plane;
    truth::Plane picture((plane.width + every - 1) / every, (plane.height + every - 1) / every);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) picture.at(x, y) = plane.at(x * every, y * every);
    return picture;
}

std::string safe(std::string text) {
    for (char& c : text)
        if (!std::isalnum((unsigned char)c) && c != '.' && c != '-') c = '-';
    return text;
}

// The references of a shot as one EXR of obscurance channels, which --reference can read.
void writeReferences(const fs::path& stem, const ShotResult& shot) {
    truth::Picture picture;
    for (const measure::ShotReference& reference : shot.references) {
        if (picture.find(reference.fileName)) continue;  // a stored channel may serve several falloffs
        truth::Plane obscurance = evaluatedPixels(reference.visibility, shot.every);
        app::writePng(stem.string() + ".reference." + safe(reference.fileName) + ".png", measure::greyPicture(obscurance));
        for (float& value : obscurance.values) value = 1.0f - value;
        picture.add(reference.fileName, std::move(obscurance));
    }
    truth::writeExr(stem.string() + ".reference.exr", picture);
}

}  // namespace

std::string shotFileName(const ShotResult& shot) {
    // A camera file counts by its name, without its folder.
    std::string camera = shot.camera.substr(shot.camera.find_last_of('/') + 1);
    if (camera.ends_with(".json")) camera.resize(camera.size() - 5);
    return safe(shot.scene + "." + camera);
}

void writeFolder(const std::vector<ShotResult>& shots, const Options& options, const About& about) {
    for (const ShotResult& shot : shots) {
        const fs::path stem = options.out / shotFileName(shot);
        for (const Drawn& drawn : shot.drawn) {
            const std::string name = fmt::format(
                "{}.{}.{}", stem.string(), options.candidates[drawn.candidate].fileName(), options.falloffs[drawn.falloff].fileName());
            truth::writeExr(name + ".visibility.exr", one("Y", drawn.visibility));
            app::writePng(name + ".visibility.png", measure::greyPicture(drawn.visibility));
            if (!drawn.bentNormals.empty())
                app::writePng(name + ".bent.png", measure::directionPicture(drawn.bentNormals, shot.size.x, shot.size.y));
        }
        for (const Row& row : shot.rows) {
            const Drawn& drawn = shot.drawn[row.drawn];
            const measure::ShotReference& reference = shot.references[row.reference];
            app::writePng(fmt::format("{}.{}.{}.error.{}.png", stem.string(), options.candidates[drawn.candidate].fileName(),
                              options.falloffs[drawn.falloff].fileName(), safe(reference.fileName.substr(0, reference.fileName.find('.')))),
                measure::errorPicture(evaluatedPixels(drawn.visibility, shot.every), evaluatedPixels(reference.visibility, shot.every)));
        }
        writeReferences(stem, shot);
    }
    app::writeFile(options.out / "metrics.json", scene::dump(rowsJson(shots, options, about), 2) + "\n");
    app::writeFile(options.out / "metrics.md", markdown(shots, options, about));
}

void writeCaptures(const std::vector<ShotResult>& shots, const fs::path& path) {
    std::string stem = path.string();
    for (const std::string_view end : {".capture.exr", ".exr", ".json"})
        if (stem.size() > end.size() && stem.ends_with(end)) stem.resize(stem.size() - end.size());
    for (const ShotResult& shot : shots) truth::writeCapture(shots.size() == 1 ? stem : stem + "." + shotFileName(shot), shot.frame);
}

}  // namespace obscura::evaluate

// libFuzzer on the bench.json that --from and --compare read: any bytes give results that can be compared and reported, or one line.
#include "compare.h"
#include "results.h"
#include "tables.h"
#include "target.h"

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    return obscura::fuzz::mutateJsonText(data, size, maxSize, seed, R"({"device":"d","command":"c","guard":0.1,"frames":2,"warmUp":1,
        "rounds":2,"rays":32,"flickerFrames":2,"flickerSize":[32,18],"gpu":"","gpuCompiler":"","rows":[
        {"method":"hbao","preset":"default","settings":"","baseline":true,"scene":"s","camera":"own","width":64,"height":36,
        "falloff":"quadratic:2","triangles":12,"reach":2,"varied":"steps","samples":4,"bytes":100,
        "milliseconds":{"median":1.5,"p95":2,"frame":1,"rounds":[1.4,1.6],"passes":[{"name":"hbao.horizons","median":1,"p95":2}]},
        "errors":[{"reference":"world","eA":0.1,"bias":0,"rmse":0.1,"p99":0.3,"ssim":0.9}],"flicker":{"ofError":0.1,"ofReference":0.1},
        "gpu":{"cycles":100,"guessed":false,"ms_arithmetic":1,"ms_memory":1,"vgprs":40,"waves":10,"geometry":""}},
        {"method":"gtao","preset":"high","settings":"","baseline":false,"scene":"s","camera":"own","width":64,"height":36,
        "falloff":"quadratic:2","triangles":12,"reach":2,"varied":"","samples":0,"bytes":100,
        "milliseconds":{"median":1,"p95":2,"frame":1,"rounds":[1,1],"passes":[]},"errors":[]}]})");
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura;
    fuzz::expectOneLine([&] {
        const bench::Results results = bench::readResults(fuzz::file("bench.json", {data, size}));
        fuzz::expectOneLine([&] { comparisonText(bench::compare(results, results, {}), {}); });
        fuzz::expectOneLine([&] { bench::briefTable(results); });
        fuzz::expectOneLine([&] { bench::costTable(results); });
        bench::csv(results);
        bench::passesCsv(results);
        bench::report(results);
        bench::jsonText(results);
    });
    return 0;
}

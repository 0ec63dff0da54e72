// The shader compiler, its text format and the shader library, without a device.
#include <algorithm>
#include <thread>

#include "gpu/test_shaders.h"

using namespace obscura;
using namespace obscura::gpu;

namespace {

constexpr const char* kEverything =
    "#version 460\n"
    "#include \"shared/terms.h\"\n"
    "#include \"local.glsl\"\n"
    "layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;\n"
    "layout(binding = 0) uniform sampler2D depth;\n"
    "layout(binding = 1, r8) writeonly uniform image2D target;\n"
    "layout(binding = 2, r32f) readonly uniform image3D volume;\n"
    "layout(binding = 3, r32ui) uniform uimage2D counters;\n"
    "layout(std430, binding = 4) readonly buffer In { float values[]; } source;\n"
    "layout(std430, binding = 5) writeonly buffer Out { float first; float rest[]; };\n"
    "layout(std430, binding = 6) buffer Both { readonly float a; float b; } both;\n"
    "layout(set = 1, binding = 2) uniform Frame { Terms terms; } frame;\n"
    "layout(push_constant) uniform Push { vec4 a; float b; } push;\n"
    "void main() {\n"
    "    first = source.values[0] + push.b + frame.terms.radius + local();\n"
    "}\n";

void writeEverything(test::TestShaders& shaders) {
    shaders.write("shared/terms.h", "#pragma once\nstruct Terms { float radius; };\n");
    shaders.write("ao/local.glsl", "#include <shared/terms.h>\nfloat local() { return 1.0; }\n");
    shaders.write("ao/everything.comp", kEverything);
}

TEST(ShaderCompiler, ReflectsDeclaredInterfaces) {
    test::TestShaders shaders;
    writeEverything(shaders);
    const Shader shader = shaders.compile("ao/everything.comp");
    EXPECT_EQ(describe(shader),
        "comp 8 4 2 20 0.0:sampledImage:r:depth 0.1:storageImage:w:target 0.2:storageImage:r:volume 0.3:storageImage:rw:counters "
        "0.4:storageBuffer:r:source 0.5:storageBuffer:w:Out 0.6:storageBuffer:rw:both 1.2:uniformBuffer:r:frame");
}

TEST(ShaderCompiler, NamesEveryFileItRead) {
    test::TestShaders shaders;
    writeEverything(shaders);
    Shader shader;
    std::string error;
    std::vector<std::filesystem::path> files;
    ASSERT_TRUE(compileShader(shaders.root(), "ao/everything.comp", shader, error, files)) << error;
    const std::vector<std::filesystem::path> expected{
        shaders.root() / "ao/everything.comp", shaders.root() / "shared/terms.h", shaders.root() / "ao/local.glsl"};
    ASSERT_EQ(files.size(), expected.size());
    for (const auto& file : expected) EXPECT_NE(std::find(files.begin(), files.end(), file.lexically_normal()), files.end()) << file;
}

TEST(ShaderCompiler, ErrorsCarryFileAndLine) {
    test::TestShaders shaders;
    shaders.write("ao/broken.comp", "#version 460\nlayout(local_size_x = 1) in;\nvoid main() {\n    float a = nothing;\n}\n");
    EXPECT_EQ(shaders.compileError("ao/broken.comp"), "shaders/ao/broken.comp:4: 'nothing' : undeclared identifier");
    // Two errors in one line of code give two lines of text.
    shaders.write("ao/broken.comp",
        "#version 460\nlayout(local_size_x = 1) in;\nstruct S { float a; };\nvoid main() {\n    S s;\n    float a = s.b + vec2(1);\n}\n");
    const std::string error = shaders.compileError("ao/broken.comp");
    EXPECT_TRUE(error.starts_with("shaders/ao/broken.comp:6: 'b' : no such field")) << error;
    EXPECT_NE(error.find("\nshaders/ao/broken.comp:6: "), std::string::npos) << error;
    EXPECT_EQ(error.find("ERROR"), std::string::npos) << error;
    EXPECT_NE(error.back(), '\n');
}

TEST(ShaderCompiler, ErrorsInAnIncludeNameTheInclude) {
    test::TestShaders shaders;
    shaders.write("ao/part.glsl", "// fine\n// fine\nfloat part() { return }\n");
    shaders.write("ao/whole.comp", "#version 460\n#include \"part.glsl\"\nvoid main() {}\n");
    EXPECT_TRUE(shaders.compileError("ao/whole.comp").starts_with("shaders/ao/part.glsl:3: "));
    shaders.write("ao/whole.comp", "#version 460\n\n#include \"absent.glsl\"\nvoid main() {}\n");
    const std::string error = shaders.compileError("ao/whole.comp");
    EXPECT_TRUE(error.starts_with("shaders/ao/whole.comp:3: ")) << error;
    EXPECT_NE(error.find("'absent.glsl'"), std::string::npos) << error;
}

TEST(ShaderCompiler, RefusesUnsupportedFeatures) {
    test::TestShaders shaders;
    const std::string head = "#version 460\nlayout(local_size_x = 1) in;\n";
    shaders.write("array.comp", head + "layout(binding = 0) uniform sampler2D maps[4];\nvoid main() {}\n");
    EXPECT_NE(shaders.compileError("array.comp").find("shaders/array.comp: 'maps' is an array"), std::string::npos);
    shaders.write("separate.comp", head + "layout(binding = 0) uniform texture2D map;\nvoid main() {}\n");
    EXPECT_NE(shaders.compileError("separate.comp").find("'map'"), std::string::npos);
    shaders.write(
        "twice.comp", head + "layout(binding = 0) uniform sampler2D a;\nlayout(binding = 0) uniform sampler2D b;\nvoid main() {}\n");
    EXPECT_NE(shaders.compileError("twice.comp").find("share set 0 binding 0"), std::string::npos);
    shaders.write("size.comp", "#version 460\nlayout(local_size_x_id = 0) in;\nvoid main() {}\n");
    EXPECT_NE(shaders.compileError("size.comp").find("workgroup"), std::string::npos);
    shaders.write("loop.glsl", "#include \"loop.glsl\"\n");
    shaders.write("loop.comp", head + "#include \"loop.glsl\"\nvoid main() {}\n");
    EXPECT_NE(shaders.compileError("loop.comp").find("loop.glsl"), std::string::npos);
    shaders.write("main.comp", head + "void other() {}\n");
    EXPECT_TRUE(shaders.compileError("main.comp").starts_with("shaders/main.comp: "));
    shaders.write("odd.glsl", "");
    EXPECT_NE(shaders.compileError("odd.glsl").find(".comp, .vert or .frag"), std::string::npos);
    EXPECT_EQ(shaders.compileError("absent.comp"), "shaders/absent.comp: cannot be read");
}

TEST(ShaderCompiler, StrippedCodeIsSmallerAndValid) {
    test::TestShaders shaders;
    writeEverything(shaders);
    const Shader shader = shaders.compile("ao/everything.comp");
    std::vector<uint32_t> stripped = shader.spirv;
    stripDebugInfo(stripped);
    EXPECT_LT(stripped.size(), shader.spirv.size());
    Shader again;
    again.spirv = stripped;
    std::string error;
    ASSERT_TRUE(reflect(again, error)) << error;
    EXPECT_EQ(again.bindings.size(), shader.bindings.size());
    EXPECT_EQ(again.workgroup, shader.workgroup);
}

constexpr const char* kVariants =
    "#version 460\n"
    "#pragma variant TWICE\n"
    "#pragma variant TWICE,FACTOR=3.0\r\n"
    "layout(local_size_x = 1) in;\n"
    "layout(binding = 0) buffer B { float b; };\n"
    "#ifndef FACTOR\n"
    "#define FACTOR 1.0\n"
    "#endif\n"
    "void main() {\n"
    "#ifdef TWICE\n"
    "    b = FACTOR * 2.0;\n"
    "#else\n"
    "    b = FACTOR;\n"
    "#endif\n"
    "}\n";

TEST(ShaderCompiler, variantsAreNamedByTheFileAndCompiledWithTheirMacros) {
    test::TestShaders shaders;
    shaders.write("ao/many.comp", kVariants);
    const std::vector<std::string> expected{"ao/many.comp", "ao/many.comp:TWICE", "ao/many.comp:TWICE,FACTOR=3.0"};
    EXPECT_EQ(variantsOf(shaders.root(), "ao/many.comp"), expected);
    const std::string text = kVariants;
    const auto withMacros = [&](const std::string& macros) {  // the same, with the macros written into the file
        shaders.write("ao/plain.comp", "#version 460\n" + macros + text.substr(text.find("layout")));
        return shaders.compile("ao/plain.comp").spirv;
    };
    const auto stripped = [](std::vector<uint32_t> spirv) {  // line numbers differ
        stripDebugInfo(spirv);
        return spirv;
    };
    EXPECT_EQ(stripped(shaders.compile(expected[0]).spirv), stripped(withMacros("")));
    EXPECT_EQ(stripped(shaders.compile(expected[1]).spirv), stripped(withMacros("#define TWICE 1\n")));
    EXPECT_EQ(stripped(shaders.compile(expected[2]).spirv), stripped(withMacros("#define TWICE 1\n#define FACTOR 3.0\n")));
    EXPECT_NE(stripped(shaders.compile(expected[1]).spirv), stripped(shaders.compile(expected[2]).spirv));
}

TEST(ShaderCompiler, errorsOfAVariantNameIt) {
    test::TestShaders shaders;
    shaders.write("ao/broken.comp",
        "#version 460\n#ifndef VALUE\n#define VALUE 1.0\n#endif\nlayout(local_size_x = 1) in;\nvoid main() {\n    float a = VALUE;\n}\n");
    shaders.compile("ao/broken.comp");
    EXPECT_EQ(shaders.compileError("ao/broken.comp:VALUE=nothing"),
        "shaders/ao/broken.comp:7: 'nothing' : undeclared identifier (variant VALUE=nothing)");
}

TEST(ShaderCompiler, CompilesOnSeveralThreads) {
    test::TestShaders shaders;
    writeEverything(shaders);
    const std::vector<uint32_t> expected = shaders.compile("ao/everything.comp").spirv;
    std::vector<std::vector<uint32_t>> results(4);
    std::vector<std::thread> threads;
    threads.reserve(results.size());
    for (auto& result : results)
        threads.emplace_back([&] {
            Shader shader;
            std::string error;
            std::vector<std::filesystem::path> files;
            compileShader(shaders.root(), "ao/everything.comp", shader, error, files);
            result = shader.spirv;
        });
    for (std::thread& thread : threads) thread.join();
    for (const auto& result : results) EXPECT_EQ(result, expected);
}

TEST(ShaderText, DescribeAndUndescribeAgree) {
    Shader shader;
    shader.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    shader.workgroup = {16, 2, 1};
    shader.pushConstantBytes = 128;
    shader.bindings = {{0, 0, BindingKind::sampledImage, true, false, "depth"}, {0, 7, BindingKind::storageImage, false, true, "target"},
        {2, 31, BindingKind::storageBuffer, true, true, "both"}, {3, 1, BindingKind::uniformBuffer, true, false, ""},
        {3, 2, BindingKind::storageBuffer, false, false, "neither"}};
    const std::string text = describe(shader);
    Shader read;
    read.spirv = {1, 2, 3};
    ASSERT_TRUE(undescribe(text, read)) << text;
    EXPECT_EQ(read.stage, shader.stage);
    EXPECT_EQ(read.workgroup, shader.workgroup);
    EXPECT_EQ(read.spirv.size(), 3u) << "undescribe() must not change the code";
    ASSERT_EQ(read.bindings.size(), shader.bindings.size());
    EXPECT_EQ(describe(read), text);
}

TEST(ShaderText, MalformedDescriptionsAreRefusedAndChangeNothing) {
    for (const char* text : {"", "comp", "geom 1 1 1 0", "comp 1 1 0", "comp 1 1 x 0", "comp 1 1 -1 0", "comp 1 1 1 0 0.0",
             "comp 1 1 1 0 0.0:sampledImage", "comp 1 1 1 0 0.0:teapot:r:a", "comp 1 1 1 0 0.0:sampledImage:q:a",
             "comp 1 1 1 0 a.0:sampledImage:r:a", "comp 1 1 1 99999999999"}) {
        Shader shader;
        shader.pushConstantBytes = 77;
        EXPECT_FALSE(undescribe(text, shader)) << text;
        EXPECT_EQ(shader.pushConstantBytes, 77u);
    }
}

TEST(ShaderLibraryTest, FindsByNameAndReportsMalformedOnes) {
    const uint32_t code[] = {1, 2};
    const EmbeddedShader embedded[] = {{"good.comp", code, "comp 8 8 1 0"}, {"bad.comp", code, "nonsense"}};
    ShaderLibrary library;
    library.add(embedded);
    ASSERT_NE(library.find("good.comp"), nullptr);
    EXPECT_EQ(library.find("good.comp")->workgroup[0], 8u);
    EXPECT_EQ(library.generation("good.comp"), 1u);
    EXPECT_EQ(library.find("absent.comp"), nullptr);
    EXPECT_EQ(library.generation("absent.comp"), 0u);
    ASSERT_EQ(library.errors().size(), 1u);
    EXPECT_NE(library.errors()[0].find("bad.comp"), std::string::npos);
    EXPECT_FALSE(library.poll()) << "no folder is watched";
}

TEST(ShaderLibraryTest, recompilesVariantsWithTheirMacros) {
    test::TestShaders shaders;
    shaders.write("many.comp", kVariants);
    for (const std::string& name : variantsOf(shaders.root(), "many.comp")) {
        const gpu::Shader shader = shaders.compile(name);
        const std::string reflection = describe(shader);
        const gpu::EmbeddedShader embedded{name.c_str(), shader.spirv, reflection.c_str()};
        shaders.library.add({&embedded, 1});
    }
    shaders.library.watch(shaders.root(), compileShader);
    std::string text = kVariants;
    text.replace(text.find("2.0"), 3, "4.0");
    shaders.write("many.comp", text);
    EXPECT_TRUE(shaders.library.poll());
    EXPECT_EQ(shaders.library.generation("many.comp"), 1u) << "its code is the same";
    EXPECT_EQ(shaders.library.generation("many.comp:TWICE"), 2u);
    EXPECT_EQ(shaders.library.generation("many.comp:TWICE,FACTOR=3.0"), 2u);
    EXPECT_EQ(shaders.library.find("many.comp:TWICE")->spirv, shaders.compile("many.comp:TWICE").spirv);
}

TEST(ShaderLibraryTest, RecompilesOnlyAffectedShaders) {
    test::TestShaders shaders;
    const std::string head = "#version 460\nlayout(local_size_x = 1) in;\nlayout(binding = 0) buffer B { float b; };\n";
    shaders.write("common.glsl", "const float kCommon = 1.0;\n");
    shaders.add("a.comp", head + "#include \"common.glsl\"\nvoid main() { b = kCommon; }\n");
    shaders.add("b.comp", head + "#include \"common.glsl\"\nvoid main() { b = 2.0 * kCommon; }\n");
    shaders.add("c.comp", head + "void main() { b = 3.0; }\n");
    int compiled = 0;
    shaders.library.watch(shaders.root(), [&](const auto& root, std::string_view name, Shader& out, std::string& error, auto& files) {
        ++compiled;
        return compileShader(root, name, out, error, files);
    });
    EXPECT_FALSE(shaders.library.poll());
    EXPECT_EQ(compiled, 0);
    const Shader* const a = shaders.library.find("a.comp");
    shaders.write("common.glsl", "const float kCommon = 5.0;\n");
    EXPECT_TRUE(shaders.library.poll());
    EXPECT_EQ(compiled, 2);
    EXPECT_EQ(shaders.library.find("a.comp"), a) << "pointers stay valid";
    EXPECT_EQ(shaders.library.generation("a.comp"), 2u);
    EXPECT_EQ(shaders.library.generation("c.comp"), 1u);
    shaders.write("c.comp", head + "// a comment\nvoid main() { b = 3.0; }\n");
    EXPECT_FALSE(shaders.library.poll()) << "the code is the same";
    EXPECT_EQ(compiled, 3);
    EXPECT_EQ(shaders.library.generation("c.comp"), 1u);
    // Saving by renaming: the file is missing for a moment.
    std::filesystem::rename(shaders.root() / "c.comp", shaders.root() / "c.saved");
    EXPECT_FALSE(shaders.library.poll());
    EXPECT_TRUE(shaders.library.errors().empty());
    EXPECT_EQ(compiled, 3);
    shaders.write("c.comp", head + "void main() { b = 4.0; }\n");
    EXPECT_TRUE(shaders.library.poll());
}

}  // namespace

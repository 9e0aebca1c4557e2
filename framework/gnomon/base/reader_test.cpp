#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "gnomon/base/json.h"

namespace gnomon {
namespace {

enum class Kernel : int { box, gaussian };

struct Bias {
  float slope = 1.5f;
  float constant = 0.0f;
};

struct Source {
  double radius = 0.25;
  std::string shape = "disc";
};

struct Thing {
  bool on = false;
  int taps = 5;
  float spread = 0.1f;
  double angle = 45.0;
  Kernel kernel = Kernel::gaussian;
  std::string name = "thing";
  glm::ivec2 size{512, 512};
  glm::dvec2 offset{0.0, 0.0};
  glm::dvec3 position{1.0, 2.0, 3.0};
  Source source;
  std::optional<Source> second;
  std::optional<int> limit;
  std::vector<Source> sources;
  std::vector<std::string> names{"a"};
  std::vector<std::string> images{"x"};
  Bias bias;
};

ParameterTable<Bias> biasTable() {
  return ParameterTable<Bias>{real("slope", &Bias::slope, {.min = 0.0}, Binding::uniform, "per texel"),
                              real("constant", &Bias::constant, {}, Binding::uniform, "fixed")}
      .checked([](const Bias& bias, const Location& where, Problems& problems) {
        if (bias.constant > bias.slope) problems.add(where.file, where.child("constant").pointer, "above slope");
      });
}

std::shared_ptr<const FieldTable> sourceTable() {
  return ParameterTable<Source>{
      real("radius", &Source::radius, {.min = 0.0, .unit = "metres"}, Binding::structure, "how wide").mandatory(),
      text("shape", &Source::shape, "its shape")}
      .table();
}

std::shared_ptr<const FieldTable> thingTable() {
  return ParameterTable<Thing>{
      boolean("on", &Thing::on, Binding::structure, "a switch"),
      integer("taps", &Thing::taps, {.min = 1, .max = 31, .unit = "texels"}, Binding::specialise, "kernel width"),
      real("spread", &Thing::spread, {.min = 0.0, .max = 16.0, .openMin = true}, Binding::uniform, "distance"),
      real("angle", &Thing::angle, {}, Binding::uniform, "an angle"),
      choice("kernel", &Thing::kernel, {"box", "gaussian"}, Binding::specialise, "weights"),
      text("name", &Thing::name, "a name"),
      size("size", &Thing::size, {.min = 1, .max = 16384, .unit = "texels"}, Binding::structure, "a size"),
      vector("offset", &Thing::offset, {.min = -1.0, .max = 1.0}, "an offset"),
      vector("position", &Thing::position, {}, "a place"),
      object("source", &Thing::source, sourceTable(), "a source"),
      object("second", &Thing::second, sourceTable(), "another"),
      integer("limit", &Thing::limit, {}, Binding::structure, "an optional limit"),
      list("sources", &Thing::sources, sourceTable(), "many"),
      list("names", &Thing::names, nullptr, "free names"),
      list("images", &Thing::images, nullptr, "some images").among({"x", "y"}),
      inlined(&Thing::bias, biasTable(), "bias.")}
      .checked([](const Thing& thing, const Location& where, Problems& problems) {
        if (thing.taps == 13) problems.add(where.file, where.child("taps").pointer, "13 is unlucky");
      })
      .table();
}

Thing read(const std::string& text, Problems& problems) {
  Thing thing;
  const std::optional<Json> json = parseJson("f", text, problems);
  if (json) readObject(*json, *thingTable(), &thing, {"f", ""}, problems);
  return thing;
}

std::vector<std::string> faults(const std::string& text) {
  Problems problems;
  read(text, problems);
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list()) lines.push_back(problem.line());
  return lines;
}

Thing readWell(const std::string& text) {
  Problems problems;
  Thing thing = read(text, problems);
  EXPECT_TRUE(problems.empty()) << problems.list().front().line();
  return thing;
}

TEST(Reader, ReadsEveryType) {
  const Thing thing = readWell(R"({"on": true, "taps": 7, "spread": 0.5, "angle": -3, "kernel": "box", "name": "n",
    "size": [10, 20], "offset": [-1, 1], "position": [4, 5, 6.5], "source": {"radius": 2}, "second": {"radius": 3, "shape": "s"},
    "limit": -7, "sources": [{"radius": 1}, {"radius": 2}], "names": ["p", "p"], "images": ["y", "x"], "bias.slope": 3})");
  EXPECT_TRUE(thing.on);
  EXPECT_EQ(thing.taps, 7);
  EXPECT_EQ(thing.spread, 0.5f);
  EXPECT_EQ(thing.angle, -3.0);
  EXPECT_EQ(thing.kernel, Kernel::box);
  EXPECT_EQ(thing.name, "n");
  EXPECT_EQ(thing.size, glm::ivec2(10, 20));
  EXPECT_EQ(thing.offset, glm::dvec2(-1.0, 1.0));
  EXPECT_EQ(thing.position, glm::dvec3(4.0, 5.0, 6.5));
  EXPECT_EQ(thing.source.radius, 2.0);
  EXPECT_EQ(thing.second->shape, "s");
  EXPECT_EQ(thing.limit, -7);
  ASSERT_EQ(thing.sources.size(), 2U);
  EXPECT_EQ(thing.sources[1].radius, 2.0);
  EXPECT_EQ(thing.names, (std::vector<std::string>{"p", "p"}));
  EXPECT_EQ(thing.images, (std::vector<std::string>{"y", "x"}));  // the default list is replaced
  EXPECT_EQ(thing.bias.slope, 3.0f);
}

TEST(Reader, WhatIsNotNamedKeepsItsDefault) {
  const Thing thing = readWell(R"({"$schema": "thing.schema.json"})");
  EXPECT_EQ(thing.taps, 5);
  EXPECT_FALSE(thing.limit);
  EXPECT_FALSE(thing.second);
  EXPECT_EQ(thing.names.size(), 1U);
}

TEST(Reader, OneNumberIsASquareSize) {
  EXPECT_EQ(readWell(R"({"size": 64})").size, glm::ivec2(64, 64));
}

TEST(Reader, WholeNumbersAreIntegersHoweverWritten) {
  EXPECT_EQ(readWell(R"({"taps": 3.0})").taps, 3);
  EXPECT_EQ(readWell(R"({"taps": 1e1})").taps, 10);
  EXPECT_EQ(faults(R"({"taps": 3.5})"),
            (std::vector<std::string>{"f: /taps: found 3.5; allowed: an integer from 1 to 31 texels"}));
}

TEST(Reader, ReportsAllFaultsAtOnceInTheOrderOfTheFile) {
  EXPECT_EQ(
      faults(R"({"tasp": 1, "taps": 32, "kernel": "bo", "on": 1, "sources": [{"radius": 1}, {"shape": 2}], "size": [0, 5]})"),
      (std::vector<std::string>{
          "f: /tasp: unknown key \"tasp\"; did you mean \"taps\"? allowed: on, taps, spread, angle, kernel, name, size, "
          "offset, "
          "position, source, second, limit, sources, names, images, bias.slope, bias.constant",
          "f: /taps: found 32; allowed: an integer from 1 to 31 texels",
          "f: /kernel: unknown choice \"bo\"; did you mean \"box\"? allowed: box, gaussian",
          "f: /on: found 1; allowed: true or false",
          "f: /sources/1/shape: found 2; allowed: text",
          "f: /sources/1: the key \"radius\" is missing: how wide",
          "f: /size: found [0,5]; allowed: one integer (square) or two [width, height], each from 1 to 16384 texels",
      }));
}

TEST(Reader, EndsOfARangeAreInsideUnlessOpen) {
  EXPECT_TRUE(faults(R"({"taps": 1})").empty());
  EXPECT_TRUE(faults(R"({"taps": 31})").empty());
  EXPECT_EQ(faults(R"({"taps": 0})").size(), 1U);
  EXPECT_TRUE(faults(R"({"spread": 16})").empty());
  EXPECT_EQ(faults(R"({"spread": 0})"), (std::vector<std::string>{"f: /spread: found 0; allowed: a number above 0 up to 16"}));
}

TEST(Reader, NumbersThatTheTypeCannotHoldAreOutOfRange) {
  EXPECT_EQ(faults(R"({"limit": 2147483648})"), (std::vector<std::string>{"f: /limit: found 2147483648; allowed: an integer"}));
  EXPECT_TRUE(faults(R"({"limit": 2147483647})").empty());
  EXPECT_EQ(faults(R"({"limit": 123456789012345678901234567890})").size(), 1U);
  EXPECT_EQ(faults(R"({"bias.slope": 1e39})").size(), 1U);  // no float
  EXPECT_EQ(faults(R"({"spread": 1e-60})").size(), 1U);     // its float is 0, which is excluded
}

TEST(Reader, NonFiniteNumbersAreFaults) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Thing thing;
    Problems problems;
    readObject(Json{{"angle", bad}}, *thingTable(), &thing, {"f", ""}, problems);
    EXPECT_EQ(problems.list().size(), 1U) << bad;
  }
}

TEST(Reader, WrongTypesAreFaults) {
  for (const char* text : {R"({"on": "true"})",
                           R"({"taps": "5"})",
                           R"({"taps": null})",
                           R"({"angle": true})",
                           R"({"kernel": 0})",
                           R"({"name": 1})",
                           R"({"size": [1]})",
                           R"({"size": [1, 2, 3]})",
                           R"({"size": "1"})",
                           R"({"offset": 1})",
                           R"({"offset": [0, 0, 0]})",
                           R"({"offset": [0, 2]})",
                           R"({"position": [1, 2]})",
                           R"({"position": [1, 2, "3"]})",
                           R"({"source": []})",
                           R"({"sources": {}})",
                           R"({"sources": [1]})",
                           R"({"names": "a"})",
                           R"({"names": [1]})",
                           R"({"limit": []})",
                           R"({"$schema": 1})",
                           "[]",
                           "1"}) {
    EXPECT_EQ(faults(text).size(), 1U) << text;
  }
}

TEST(Reader, NamesOutOfAListMustBeKnownAndDifferent) {
  EXPECT_EQ(faults(R"({"images": ["x", "z", "x"]})"),
            (std::vector<std::string>{"f: /images/1: unknown name \"z\"; did you mean \"x\"? allowed: x, y",
                                      "f: /images/2: \"x\" is listed twice"}));
}

TEST(Reader, SchemaKeyIsAllowedAtTheTopAlone) {
  EXPECT_EQ(faults(R"({"source": {"$schema": "s", "radius": 1}})").size(), 1U);
}

TEST(Reader, LongValuesAreShownShort) {
  const auto lines = faults(R"({"taps": ")" + std::string(5000, 'x') + "\"}");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT(lines[0].size(), 200U);
}

TEST(Reader, ChecksRunOnlyOnFieldsWithoutFault) {
  EXPECT_EQ(faults(R"({"taps": 13})"), (std::vector<std::string>{"f: /taps: 13 is unlucky"}));
  EXPECT_EQ(faults(R"({"taps": 13, "on": 1})").size(), 1U);
}

TEST(Reader, CheckOfAnInlinedStructPointsAtItsFlatKey) {
  EXPECT_EQ(faults(R"({"bias.slope": 1, "bias.constant": 2})"), (std::vector<std::string>{"f: /bias.constant: above slope"}));
}

TEST(Writer, ReadsBackWhatItWrote) {
  Thing thing =
      readWell(R"({"on": true, "size": [3, 4], "second": {"radius": 0.1}, "sources": [{"radius": 1}], "images": []})");
  const Json written = writeObject(*thingTable(), &thing);
  const Thing again = readWell(written.dump());
  EXPECT_EQ(writeObject(*thingTable(), &again), written);
  EXPECT_EQ(written["second"]["radius"], 0.1);
  EXPECT_EQ(written["kernel"], "gaussian");
  EXPECT_FALSE(written.contains("limit"));
}

TEST(Writer, FloatsAreWrittenShort) {
  const Thing thing;
  EXPECT_EQ(writeObject(*thingTable(), &thing)["spread"].dump(), "0.1");
}

TEST(ValueText, IsForPeople) {
  const Thing thing;
  const auto text = [&](const char* name) { return valueText(*thingTable()->find(name), &thing); };
  EXPECT_EQ(text("taps"), "5");
  EXPECT_EQ(text("kernel"), "gaussian");
  EXPECT_EQ(text("spread"), "0.1");
  EXPECT_EQ(text("size"), "512");
  EXPECT_EQ(text("limit"), "none");
  EXPECT_EQ(text("bias.slope"), "1.5");
}

TEST(AllowedText, TellsRangesWithUnits) {
  EXPECT_EQ(allowedText(*thingTable()->find("taps")), "an integer from 1 to 31 texels");
  EXPECT_EQ(allowedText(*thingTable()->find("bias.slope")), "a number at least 0");
  EXPECT_EQ(allowedText(*sourceTable()->find("radius")), "a number at least 0 metres");
  EXPECT_EQ(allowedText(*thingTable()->find("angle")), "a number");
}

// --- integers of which some are left out ---

struct Stepped {
  int odd = 3;
  glm::ivec2 tiles{64, 64};
  float epsilon = 1e-3f;
};

std::shared_ptr<const FieldTable> steppedTable() {
  return ParameterTable<Stepped>{
      integer("odd", &Stepped::odd, {.min = 1, .max = 31, .odd = true}, Binding::specialise, "width"),
      size("tiles", &Stepped::tiles, {.min = 1, .max = 256, .unit = "texels", .step = 64}, Binding::structure, "a size"),
      real("epsilon", &Stepped::epsilon, {.min = 1e-6, .max = 1.0, .logarithmic = true}, Binding::uniform, "a threshold")}
      .table();
}

std::size_t steppedFaults(const std::string& text) {
  Problems problems;
  Stepped stepped;
  readObject(Json::parse(text), *steppedTable(), &stepped, {"f", ""}, problems);
  return problems.list().size();
}

TEST(Reader, IntegersThatAreLeftOutAreFaults) {
  for (const char* text : {R"({"odd": 4})", R"({"tiles": 100})", R"({"tiles": [64, 65]})", R"({"tiles": [63, 128]})"})
    EXPECT_EQ(steppedFaults(text), 1U) << text;
  for (const char* text : {R"({"odd": 31})", R"({"odd": 5.0})", R"({"tiles": 128})", R"({"tiles": [64, 256]})"})
    EXPECT_EQ(steppedFaults(text), 0U) << text;
}

TEST(AllowedText, TellsWhichIntegersAreLeftOut) {
  EXPECT_EQ(allowedText(*steppedTable()->find("odd")), "an integer from 1 to 31, odd");
  EXPECT_EQ(allowedText(*steppedTable()->find("tiles")),
            "one integer (square) or two [width, height], each from 1 to 256 texels, a multiple of 64");
}

TEST(Schema, TellsWhichIntegersAreLeftOutAndWhatIsLogarithmic) {
  const Stepped stepped;
  const Json schema = schemaOf(*steppedTable(), &stepped);
  const Json& properties = schema["properties"];
  EXPECT_EQ(properties["odd"]["not"].dump(), R"({"type":"integer","multipleOf":2})");
  EXPECT_EQ(properties["tiles"]["multipleOf"], 64);
  EXPECT_EQ(properties["tiles"]["items"]["multipleOf"], 64);
  EXPECT_EQ(properties["epsilon"]["description"], "a threshold (logarithmic scale)");
}

TEST(Schema, DescribesWhatTheReaderAccepts) {
  const Thing thing;
  const Json schema = schemaOf(*thingTable(), &thing);
  const Json& properties = schema["properties"];
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(properties["taps"].dump(),
            R"json({"type":"integer","minimum":1,"maximum":31,"description":"kernel width (texels)","default":5})json");
  EXPECT_EQ(properties["spread"].dump(),
            R"({"type":"number","exclusiveMinimum":0,"maximum":16,"description":"distance","default":0.1})");
  EXPECT_EQ(properties["kernel"].dump(),
            R"({"type":"string","enum":["box","gaussian"],"description":"weights","default":"gaussian"})");
  EXPECT_EQ(properties["images"].dump(), R"({"type":"array","items":{"type":"string","enum":["x","y"]},"uniqueItems":true,)"
                                         R"("description":"some images","default":["x"]})");
  EXPECT_EQ(properties["second"]["properties"]["shape"]["default"], "disc");  // though the optional is empty
  EXPECT_EQ(properties["sources"]["items"]["required"].dump(), R"(["radius"])");
  EXPECT_FALSE(properties["source"].contains("$schema"));
  EXPECT_EQ(properties["size"]["type"].dump(), R"(["integer","array"])");
  EXPECT_TRUE(properties.contains("bias.slope"));
  EXPECT_TRUE(properties.contains("$schema"));
}

}  // namespace
}  // namespace gnomon

#include "gnomon/run/trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gnomon/base/clock.h"
#include "gnomon/base/json.h"

namespace gnomon {
namespace {

/// The slices of a trace, in its order, without the events that name process and thread.
std::vector<Json> slicesOf(const Trace& trace) {
  std::vector<Json> slices;
  const Json whole = Json::parse(trace.json());
  for (const Json& event : whole["traceEvents"]) {
    if (event["ph"] == "X") slices.push_back(event);
  }
  return slices;
}

TEST(Trace, TimesAreMicrosecondsSinceItBegan) {
  const double before = wallMs();
  Trace trace("test");
  const double after = wallMs();
  trace.add("slice", after + 2.0, 0.25);
  const Json slice = slicesOf(trace).at(0);
  EXPECT_GE(slice["ts"].get<double>(), 2000.0 - 0.001);
  EXPECT_LE(slice["ts"].get<double>(), 2000.0 + 1000.0 * (after - before) + 0.001);
  EXPECT_NEAR(slice["dur"].get<double>(), 250.0, 0.0011) << "whole nanoseconds";
}

TEST(Trace, ASliceThatEndsWithItsParentStaysInside) {  // as the format's readers compare them
  Trace trace("test");
  const double start = wallMs();
  for (int i = 0; i < 1000; ++i) {
    const double at = start + 0.1234567 * i;
    trace.add("outer", at, 0.0777777);
    trace.add("inner", at + 0.0333333, 0.0777777 - 0.0333333);
  }
  const std::vector<Json> slices = slicesOf(trace);
  for (std::size_t i = 0; i < slices.size(); i += 2) {
    const auto endNs = [](const Json& s) { return std::llround(1e3 * (s["ts"].get<double>() + s["dur"].get<double>())); };
    ASSERT_EQ(slices[i]["name"], "outer");
    ASSERT_LE(endNs(slices[i + 1]), endNs(slices[i]) + 1) << "two sums of two roundings in double";
  }
}

TEST(Trace, TheOuterOfTwoThatStartTogetherComesFirst) {
  Trace trace("test");
  const double now = wallMs();
  trace.add("inner", now, 1.0);
  trace.add("outer", now, 2.0);
  EXPECT_EQ(slicesOf(trace).at(0)["name"], "outer");
}

TEST(Trace, AScopeThatThrowsIsASliceToo) {
  Trace trace("test");
  try {
    const TraceSlice slice(&trace, "failing");
    throw 1;
  } catch (int) {
  }
  EXPECT_EQ(slicesOf(trace).at(0)["name"], "failing");
}

TEST(Trace, NotesAreItsArguments) {
  Trace trace("test");
  { TraceSlice(&trace, "slice", {{"technique", "pcf"}}).note("status", "ok"); }
  EXPECT_EQ(slicesOf(trace).at(0)["args"], Json::parse(R"({"status": "ok", "technique": "pcf"})"));
}

TEST(Trace, SlicesBeyondItsBoundAreCounted) {
  Trace trace("test", 2);
  for (int i = 0; i < 5; ++i) trace.add("slice", wallMs(), 1.0);
  EXPECT_EQ(slicesOf(trace).size(), 2U);
  EXPECT_EQ(Json::parse(trace.json())["otherData"]["slices_left_out"], 3);
}

TEST(Trace, BytesThatAreNoTextDoNotSpoilIt) {
  Trace trace("test");
  trace.add("\xff", wallMs(), 1.0);
  EXPECT_TRUE(Json::accept(trace.json()));
}

TEST(TraceSlice, WithoutATraceDoesNothing) {
  EXPECT_NO_THROW(TraceSlice(nullptr, "slice").note("a", "b"));
}

}  // namespace
}  // namespace gnomon

#include "lab/tables.h"

#include <gtest/gtest.h>

namespace atlaswire::lab {
namespace {

Row row(const std::string& id, const std::string& variant, double latency, std::vector<Figure> figures) {
  Row r;
  r.point.id = id;
  r.point.variant = variant;
  r.point.settings.latency_ms = latency;
  r.record.wall_s = 2;
  r.record.result.figures = std::move(figures);
  r.record.result.timings = {{"server_frame_ms", 1.5}};
  r.record.result.frames = {{.t_s = 0.25, .mssim = 0.5}};
  return r;
}

Plan plan_for(const std::vector<Row>& rows) {
  std::vector<PlannedPoint> points;
  for (const Row& r : rows) points.push_back(r.point);
  return plan_of(std::move(points));
}

TEST(Tables, HoldSettingsThatVaryAndAllFigures) {
  const std::vector<Row> rows{row("a1", "ours, \"new\"", 0, {{"mssim", 0.123456789}, {"atlas_used", 1}}),
                              row("a2", "ATW", 50, {{"mssim", kNotApplicable}, {"total_mbps", 1e7}})};
  EXPECT_EQ(results_csv(plan_for(rows), rows),
            "id,variant,varied,latency_ms,mssim,atlas_used,total_mbps\n"
            "a1,\"ours, \"\"new\"\"\",,0,0.1234568,1,\n"
            "a2,ATW,,50,,,10000000\n");
  EXPECT_EQ(timings_csv(plan_for(rows), rows),
            "id,variant,varied,latency_ms,server_frame_ms,wall_s\n"
            "a1,\"ours, \"\"new\"\"\",,0,1.5,2\n"
            "a2,ATW,,50,1.5,2\n");
  EXPECT_EQ(frames_csv(plan_for({rows[0]}), {rows[0]}),
            "id,variant,varied,t_s,mssim,psnr,dssim,flip,flicker,holes,pose_age_ms\n"
            "a1,\"ours, \"\"new\"\"\",,0.25,0.5,,,,,,\n");
}

TEST(Tables, CellsAreShortAndPlain) {
  EXPECT_EQ(cell(0.1 + 0.2), "0.3");
  EXPECT_EQ(cell(-0.0), "0");
  EXPECT_EQ(cell(123456789), "123456789");
  EXPECT_EQ(cell(kNotApplicable), "");
  EXPECT_EQ(cell(std::numeric_limits<double>::infinity()), "inf");
}

TEST(Tables, NumbersComeByNameFromFiguresTimingsAndSettings) {
  const Row r = row("a1", "ours", 50, {{"mssim", 0.5}});
  EXPECT_EQ(number_of(r, "mssim"), 0.5);
  EXPECT_EQ(number_of(r, "server_frame_ms"), 1.5);
  EXPECT_EQ(number_of(r, "latency_ms"), 50);
  EXPECT_TRUE(std::isnan(number_of(r, "method")));
  EXPECT_TRUE(std::isnan(number_of(r, "nonsense")));
}

}  // namespace
}  // namespace atlaswire::lab

#include "fit/renderer/scene_row.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

const std::string kHeader = "e,m_r,m_g,m_b,n_x,n_y,n_z,l_x,l_y,l_z,i_d,d_r,d_g,d_b,i_a,a_r,a_g,a_b";

absl::StatusOr<std::vector<SceneRow>> Rows(const std::string& text, RowMaterial material) {
  const auto table = ParseCsv("rows.csv", text);
  EXPECT_TRUE(table.ok()) << table.status();
  return SceneRowsOf(*table, material);
}

std::string Message(const std::string& text, RowMaterial material = RowMaterial::kLambertian) {
  const auto rows = Rows(text, material);
  EXPECT_FALSE(rows.ok());
  return std::string(rows.status().message());
}

TEST(SceneRowTest, ReadsEveryTermOfALambertianRow) {
  const auto rows =
      Rows(kHeader + "\n1,0.1,0.2,0.3,0,0,-1,0,0.6,-0.8,2,0.4,0.5,0.6,3,0.7,0.8,0.9\n",
           RowMaterial::kLambertian);
  ASSERT_TRUE(rows.ok()) << rows.status();
  const SceneRow& row = rows->front();
  EXPECT_EQ(row.exposure_stops, 1);
  EXPECT_EQ(row.material, (optics::Rgb{0.1, 0.2, 0.3}));
  EXPECT_DOUBLE_EQ(row.facing, 0.8);
  EXPECT_EQ(row.directional_color, (optics::Rgb{0.4, 0.5, 0.6}));
  EXPECT_EQ(row.ambient_intensity, 3);
  EXPECT_FALSE(row.stored.has_value());
}

TEST(SceneRowTest, LightFromBehindDoesNotFace) {
  const auto rows =
      Rows(kHeader + "\n0,1,1,1,0,0,-1,0,0,1,1,1,1,1,0,1,1,1\n", RowMaterial::kLambertian);
  ASSERT_TRUE(rows.ok()) << rows.status();
  EXPECT_EQ(rows->front().facing, 0);
}

TEST(SceneRowTest, AnUnlitRowNeedsItsMaterialAlone) {
  const auto rows = Rows("m_r,m_g,m_b,v_r,v_g,v_b\n0,0.5,1,0,0.5,1\n", RowMaterial::kUnlit);
  ASSERT_TRUE(rows.ok()) << rows.status();
  EXPECT_EQ(rows->front().stored, (optics::Rgb{0, 0.5, 1}));
}

TEST(SceneRowTest, ErrorsNameFileLineAndColumn) {
  EXPECT_THAT(Message("m_r,m_g\n0,0\n", RowMaterial::kUnlit), HasSubstr("m_b"));
  EXPECT_THAT(Message("m_r,m_g,m_b\n0,0,1\n0,1.5,0\n", RowMaterial::kUnlit),
              HasSubstr("rows.csv:3, column m_g"));
  EXPECT_THAT(Message("m_r,m_g,m_b\n0,0,nan\n", RowMaterial::kUnlit),
              HasSubstr("rows.csv:2, column m_b"));
  EXPECT_THAT(Message(kHeader + "\n0,1,1,1,0,0,-2,0,0,1,1,1,1,1,0,1,1,1\n"),
              HasSubstr("rows.csv:2, column n_x"));
  EXPECT_THAT(Message(kHeader + "\n0,1,1,1,0,0,-1,0,0,1,1,1,1,1,-1,1,1,1\n"),
              HasSubstr("rows.csv:2, column i_a"));
}

}  // namespace
}  // namespace eyebox::fit

// heel card and heel teach --card: the sheet has its size, and a picture of it gives the distance. The
// picture is rendered from the squares of the SVG that heel has written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "tools/heel/taught_shirt.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr double kDegree = CV_PI / 180.0;

/// How the card is held: its middle on the optical axis, but for `side_m`.
struct Held {
  double distance_m = 1.5;
  double turned_deg = 0.0;  ///< about the vertical
  double side_m = 0.03;
  double printed = 1.0;  ///< scale of the print
  double stretch = 1.0;  ///< of its height alone
  double bent_mm = 0.0;  ///< how far the middle of its height is from where it would be
  bool hand = false;     ///< over a corner of the squares
};

class Card : public test::TaughtShirt {
 protected:
  void SetUp() override {
    TaughtShirt::SetUp();
    ASSERT_EQ(run_heel({"card", "-o", sheet}).status, 0);
    read_squares();
  }

  /// The black rectangles of the SVG, millimetres; the first of `rect` is the white sheet.
  void read_squares() {
    const std::string svg = test::read_text(sheet);
    const std::regex rectangle(
        "<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"/>");
    for (std::sregex_iterator it(svg.begin(), svg.end(), rectangle), end; it != end; ++it)
      black_mm.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3]),
                            std::stod((*it)[4]));
    ASSERT_GT(black_mm.size(), 20u);
  }

  double brightness(double x_mm, double y_mm, double background) const {
    if (x_mm < 0.0 || y_mm < 0.0 || x_mm > 210.0 || y_mm > 297.0) return background;
    for (const cv::Rect2d& rectangle : black_mm)
      if (rectangle.contains({x_mm, y_mm})) return 30.0;
    return 220.0;
  }

  /// Every pixel is the mean of 3 × 3 rays; then blur and noise of a camera.
  std::string picture(const Held& held, const CameraModel& lens = test::shirt_camera()) {
    cv::Rect2d squares = black_mm.front();
    for (const cv::Rect2d& rectangle : black_mm)
      if (rectangle.width > 10.0) squares |= rectangle;
    const double middle_x_mm = squares.x + squares.width / 2, middle_y_mm = squares.y + squares.height / 2;
    const double turned_rad = held.turned_deg * kDegree;
    const double c = std::cos(turned_rad), s = std::sin(turned_rad);
    cv::Mat seen = reference.clone();
    for (int v = 0; v < seen.rows; ++v) {
      for (int u = 0; u < seen.cols; ++u) {
        double sum = 0.0;
        for (int i = 0; i < 9; ++i) {
          const Eigen::Vector2d at = lens.undistort_px({u + (i % 3 - 1) / 3.0, v + (i / 3 - 1) / 3.0});
          const double rx = (at.x() - lens.cx) / lens.fx, ry = (at.y() - lens.cy) / lens.fy;
          // (side + a cos, b, distance − a sin) for a point (a, b) of the card.
          const double a_m = (rx * held.distance_m - held.side_m) / (c + rx * s);
          const double b_m = ry * (held.distance_m - a_m * s);
          sum += brightness(middle_x_mm + 1000.0 * a_m / held.printed,
                            middle_y_mm + 1000.0 * b_m / (held.printed * held.stretch) +
                                held.bent_mm * std::cos(20.0 * b_m),
                            reference.at<std::uint8_t>(v, u));
        }
        seen.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(sum / 9.0);
      }
    }
    if (held.hand) cv::circle(seen, {322 + 12 - 21, 238 - 35}, 16, cv::Scalar(140), cv::FILLED);
    cv::GaussianBlur(seen, seen, {}, 0.6);
    cv::Mat noise(seen.size(), CV_16SC1), noisy;
    cv::theRNG().state = 5;
    cv::randn(noise, 0.0, 2.0);
    seen.convertTo(noisy, CV_16SC1);
    noisy += noise;
    noisy.convertTo(seen, CV_8UC1);
    const std::string file = folder.file("card.png");
    cv::imwrite(file, seen);
    return file;
  }

  Outcome teach_by_card(const Held& held, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "teach",         "--image", image, "--roi", test::kRoi,     "--card", picture(held),
        "--camera-info", camera,    "-o",  shirt,   "--reach-time", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_heel(arguments);
  }

  std::string sheet = folder.file("card.svg");
  std::vector<cv::Rect2d> black_mm;
};

TEST_F(Card, TheDistanceIsMeasuredWithinItsError) {
  for (const Held& held : {Held{}, Held{.distance_m = 1.0, .turned_deg = 10.0},
                           Held{.distance_m = 2.0, .turned_deg = -15.0}, Held{.distance_m = 3.0}}) {
    const Outcome outcome = teach_by_card(held, {"--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    const double distance_m = json["card"]["distance_m"], sigma_m = json["card"]["sigma_m"];
    EXPECT_NEAR(distance_m, held.distance_m, 3.0 * sigma_m);
    EXPECT_NEAR(distance_m, held.distance_m, 0.01 * held.distance_m);
    EXPECT_GT(sigma_m, 0.004 * held.distance_m);
    EXPECT_LT(sigma_m, 0.015 * held.distance_m);
    EXPECT_NEAR(json["card"]["tilt_rad"].get<double>() / kDegree, std::abs(held.turned_deg), 8.0);
    EXPECT_EQ(read_template(shirt).distance_m, distance_m);
    EXPECT_EQ(json["distance_m"], distance_m);
  }
}

TEST_F(Card, ADistortingLensIsTakenIntoAccount) {
  CameraModel lens = test::shirt_camera();
  lens.k1 = -0.3;
  lens.k2 = 0.1;
  write_camera_model(lens, camera);
  const std::string card = picture({.side_m = 0.35}, lens);
  const Outcome outcome = run_heel({"teach", "--image", image, "--roi", test::kRoi, "--card", card,
                                    "--camera-info", camera, "-o", shirt, "--reach-time", "0"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(read_template(shirt).distance_m, 1.5, 0.015);
  EXPECT_THAT(outcome.out,
              ContainsRegex("the card is 1\\.[45][0-9]+ m ± 0\\.0[0-9]+ m away, turned by [0-9]+°\n"));
}

TEST_F(Card, AnotherSizeOfTheSquaresIsSaid) {
  const Outcome outcome = teach_by_card({.printed = 0.94}, {"--card-square", "0.03196"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(read_template(shirt).distance_m, 1.5, 0.015);
}

TEST_F(Card, TheTapeCountsWhenTheCardConfirmsIt) {
  ASSERT_EQ(teach_by_card({}, {"--distance", "1.53"}).status, 0);
  EXPECT_EQ(read_template(shirt).distance_m, 1.53);
  const Outcome wrong = teach_by_card({.printed = 0.94}, {"--distance", "1.5"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, AllOf(HasSubstr("card.png: the card is 1."), HasSubstr("and --distance says 1.5 m"),
                               ContainsRegex("printed at 9[345] %, see its line of 150 mm")));
}

TEST_F(Card, WhatIsNoMeasurementIsRefused) {
  const auto refusal = [&](const Held& held) {
    const Outcome outcome = teach_by_card(held);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    return outcome.err;
  };
  EXPECT_THAT(refusal({.turned_deg = 38.0}),
              ContainsRegex("the card is turned by [34][0-9]° from the line of sight"));
  EXPECT_THAT(refusal({.distance_m = 9.0}),
              HasSubstr("card.png: the card is not seen (expected its 5x7 squares"));
  EXPECT_THAT(refusal({.hand = true}),
              ::testing::AnyOf(HasSubstr("a part of the card is seen"), HasSubstr("not seen")));
  EXPECT_THAT(refusal({.bent_mm = 8.0}),
              ContainsRegex("the card's corners are [0-9.]+ pixels from those of a flat card"));
  EXPECT_THAT(refusal({.stretch = 1.08}), HasSubstr("flat against it and printed in proportion"));
  const Outcome none = run_heel({"teach", "--image", image, "--roi", test::kRoi, "--card", image,
                                 "--camera-info", camera, "-o", shirt});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("the card is not seen"));
  const Outcome neither =
      run_heel({"teach", "--image", image, "--roi", test::kRoi, "--camera-info", camera, "-o", shirt});
  EXPECT_EQ(neither.status, 2);
  EXPECT_EQ(neither.err, "heel teach: expected --distance, or --card (see heel teach --help)\n");
}

TEST_F(Card, PdfAndSvgHaveTheSameSizes) {
  const std::string pdf = folder.file("card.pdf");
  for (const auto& [paper, width_mm, height_mm] :
       {std::tuple("a4", 210.0, 297.0), std::tuple("letter", 215.9, 279.4)}) {
    ASSERT_EQ(run_heel({"card", "-o", pdf, "--paper", paper}).status, 0);
    const std::string text = test::read_text(pdf);
    EXPECT_THAT(text, HasSubstr("/PrintScaling /None"));
    std::smatch box;
    ASSERT_TRUE(std::regex_search(text, box, std::regex("MediaBox \\[0 0 ([0-9.]+) ([0-9.]+)\\]")));
    const double mm = 25.4 / 72.0;
    EXPECT_NEAR(std::stod(box[1]) * mm, width_mm, 0.01);
    EXPECT_NEAR(std::stod(box[2]) * mm, height_mm, 0.01);
    int squares = 0, lines = 0;
    const std::regex rectangle("([0-9.]+) ([0-9.]+) ([0-9.]+) ([0-9.]+) re f");
    for (std::sregex_iterator it(text.begin(), text.end(), rectangle), end; it != end; ++it) {
      const double left = std::stod((*it)[1]) * mm, low = std::stod((*it)[2]) * mm;
      const double width = std::stod((*it)[3]) * mm, height = std::stod((*it)[4]) * mm;
      squares += std::abs(width - 34.0) < 0.001 && std::abs(height - 34.0) < 0.001;
      lines += std::abs(width - 150.0) < 0.001;
      // Printers leave a margin white.
      EXPECT_TRUE(left > 8.0 && low > 8.0 && left + width < width_mm - 8.0 && low + height < height_mm - 8.0);
    }
    EXPECT_EQ(squares, 18);
    EXPECT_EQ(lines, 1);
    // Where each object begins, as its readers rely on.
    const std::size_t table = text.rfind("\nxref\n") + 1;
    EXPECT_THAT(text, HasSubstr("startxref\n" + std::to_string(table) + "\n"));
    std::istringstream rows(text.substr(text.find("f \n", table) + 3));
    for (int object = 1; object <= 5; ++object) {
      std::string row;
      std::getline(rows, row);
      EXPECT_EQ(text.compare(std::stoul(row), 7, std::to_string(object) + " 0 obj"), 0) << row;
    }
  }
  EXPECT_THAT(run_heel({"card", "-o", folder.file("card.png")}).err,
              HasSubstr("expected a name that ends in .pdf or .svg"));
}

}  // namespace
}  // namespace heel

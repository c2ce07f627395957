// Prints our figures as JSON, for metrics_peers_test.py to hold against other implementations:
//   metrics_probe pictures REFERENCE.png PICTURE.png [PIXELS_PER_DEGREE]
//   metrics_probe flicker REFERENCE0.png PICTURE0.png REFERENCE1.png PICTURE1.png
//   metrics_probe bd RATE:QUALITY,RATE:QUALITY,... RATE:QUALITY,...    anchor, then test
#include "lab/bd_rate.h"
#include "render/image/flip.h"
#include "render/image/metrics.h"
#include "render/image/png.h"

#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace atlaswire;

std::vector<lab::RatePoint> parse_curve(const std::string& text) {
  std::vector<lab::RatePoint> curve;
  std::istringstream in(text);
  char colon = 0;
  for (lab::RatePoint p; in >> p.rate >> colon >> p.quality; in.ignore()) curve.push_back(p);
  return curve;
}

void print_pictures(const std::string& reference_path, const std::string& picture_path, double ppd) {
  const render::Picture reference = render::read_png(reference_path).value();
  const render::Picture picture = render::read_png(picture_path).value();
  const double mssim = render::mssim(reference, picture);
  std::printf("{\"mssim\": %.9g, \"dssim\": %.9g, \"psnr\": %.9g, \"flip\": %.9g, ", mssim,
              render::dssim(mssim), render::psnr(reference, picture), render::flip(reference, picture, ppd));
  std::printf("\"flip_map\": [");
  const render::FlipMap map = render::flip_map(reference, picture, ppd);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    std::printf("%s%.6g", i == 0 ? "" : ", ", double{map.values[i]});
  }
  std::printf("]}\n");
}

void print_flicker(const std::vector<std::string>& paths) {
  std::vector<render::Picture> pictures;
  for (const std::string& path : paths) pictures.push_back(render::read_png(path).value());
  std::printf("{\"flicker\": %.9g}\n",
              render::flicker({&pictures[0], &pictures[1]}, {&pictures[2], &pictures[3]}));
}

void print_differences(const std::vector<lab::RatePoint>& anchor, const std::vector<lab::RatePoint>& test) {
  const auto print = [&](const char* name, lab::CurveFit fit, const char* end) {
    std::printf("\"%s\": {\"rate\": %.12g, \"quality\": %.12g}%s", name,
                lab::bd_rate(anchor, test, fit).value(), lab::bd_quality(anchor, test, fit).value(), end);
  };
  std::printf("{");
  print("cubic", lab::CurveFit::kCubic, ", ");
  print("pchip", lab::CurveFit::kPchip, ", ");
  print("akima", lab::CurveFit::kAkima, "}\n");
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() >= 3 && words[0] == "pictures") {
      print_pictures(words[1], words[2],
                     words.size() > 3 ? std::stod(words[3]) : render::kFlipPixelsPerDegree);
    } else if (words.size() == 5 && words[0] == "flicker") {
      print_flicker({words.begin() + 1, words.end()});
    } else if (words.size() == 3 && words[0] == "bd") {
      print_differences(parse_curve(words[1]), parse_curve(words[2]));
    } else {
      std::fprintf(stderr, "metrics_probe: error: see the head of its source for what it takes\n");
      return 2;
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "metrics_probe: error: %s\n", e.what());
    return 1;
  }
  return 0;
}

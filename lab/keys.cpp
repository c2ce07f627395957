#include "lab/keys.h"

#include "lab/lab_error.h"
#include "render/image/lens_correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <type_traits>

namespace atlaswire::lab {
namespace {

using S = PointSettings;
constexpr double kMostSeed = 9.007199254740992e15;  // exact in JSON and TOML readers everywhere

constexpr std::array kKeys{
    Key{"scene", &S::scene, 0, 0, "", "built-in scene (atrium, atrium:0.2, parade) or a .glb or .gltf file"},
    Key{"path", &S::path, 0, 0, "",
        "built-in camera path (atrium, atrium-about, atrium-still, atrium-turn, parade, parade-still) or a "
        ".csv file"},
    Key{"seconds", &S::seconds, 0.01, 3600, "", "length of the path that is played, s"},
    Key{"display", &S::display, 16, 8192, "", "WxH in pixels of one eye's view"},
    Key{"horizontal_fov", &S::horizontal_fov, 1, 170, "", "horizontal field of view, degrees"},
    Key{"stereo", &S::stereo, 0, 0, "", "two eyes: every method's bytes then carry both"},
    Key{"ipd", &S::ipd, 0, 1, "", "distance between the eyes, m"},
    Key{"lens", &S::lens, 0, 0, "",
        "of a headset, that view and truth are corrected for: none, generic, or in a file K1,K2 (of each "
        "channel)"},
    Key{"method", &S::method, 0, 0, "sas atw mesh iterative", "how the client makes its frames"},
    Key{"depth", &S::depth, 0, 0, "free coded", "depth of mesh and iterative: exact without bytes, or coded"},
    Key{"predict", &S::predict, 0, 0, "", "warps render for the pose expected at display time"},
    Key{"atlas", &S::atlas, 64, 8192, "", "WxH in texels, multiples of 64 (sas)"},
    Key{"views", &S::views, 1, 16, "", "visible sets united a frame, at most (sas)"},
    Key{"prediction_step_ms", &S::prediction_step_ms, 1, 1000, "", "time between them, ms (sas)"},
    Key{"hold_frames", &S::hold_frames, 0, 1000, "",
        "frames that a patch stays after it was last seen (sas)"},
    Key{"fov_scale", &S::fov_scale, 1, 2, "", "enlargement of the server's view"},
    Key{"id_scale", &S::id_scale, 0.25, 2, "", "id pixels per display pixel along a side (sas)"},
    Key{"max_oversampling", &S::max_oversampling, 1, 8, "",
        "texels a pixel may get while the atlas has room (sas)"},
    Key{"foveation", &S::foveation, 0, 8, "",
        "octaves of atlas area that surfaces lose per radian from the view axis (sas)"},
    Key{"strategy", &S::strategy, 0, 0, "S0 S1 S2 S3 quadtree repack",
        "of the atlas's memory; repack lays every frame out anew (sas)"},
    Key{"reshade_interval", &S::reshade_interval, 1, 60, "", "every n-th frame shades a held block (sas)"},
    Key{"grid_bits", &S::grid_bits, 0, 20, "", "of the replica's grid, 8..20; 0: suited to the scene (sas)"},
    Key{"meta_codec", &S::meta_codec, 0, 0, "mirror gate plain", "how geometry travels (sas)"},
    Key{"new_patches", &S::new_patches, 0, 1'000'000, "",
        "patches that a frame may show for the first time; 0: all (sas)"},
    Key{"foresee_motion", &S::foresee_motion, 0, 0, "",
        "what moves in the scene is shown where it will be when its picture is displayed"},
    Key{"server_hz", &S::server_hz, 0.1, 1000, "", "server frames a second"},
    Key{"client_hz", &S::client_hz, 0.1, 1000, "", "displayed frames a second"},
    Key{"latency_ms", &S::latency_ms, 0, 10000, "",
        "from a pose to its frame on the client, without profile, ms"},
    Key{"profile", &S::profile, 0, 0, "", "netsim profile (a name or a .toml file) instead of latency_ms"},
    Key{"server_ms", &S::server_ms, 0, 10000, "", "processing time of a server frame, with profile, ms"},
    Key{"client_ms", &S::client_ms, 0, 10000, "", "decoding time of a client frame, with profile, ms"},
    Key{"seed", &S::seed, 0, kMostSeed, "", "of the network"},
    Key{"bitrate_mbps", &S::bitrate_mbps, 0, 10000, "",
        "Mbps of all channels together; 0: pictures are not coded"},
    Key{"qp", &S::qp, -1, 51, "", "constant quantizer, 0..51; -1: by bitrate_mbps"},
    Key{"preset", &S::preset, 0, 0, "ultrafast superfast veryfast faster fast medium slow slower veryslow",
        "x264 preset"},
    Key{"intra_interval", &S::intra_interval, 0, 10000, "",
        "frames from I-frame to I-frame; 0: only on request"},
    Key{"measure_every", &S::measure_every, 1, 100000, "",
        "every n-th displayed frame is compared with the truth"},
    Key{"measure_flip", &S::measure_flip, 0, 0, "", "FLIP as well, the slowest of the metrics"},
    Key{"foresight", &S::foresight, 0, 0, "",
        "no holes: visible sets from the poses that will be displayed (sas)"},
    Key{"shade_at_display", &S::shade_at_display, 0, 0, "",
        "no stale shading: shaded for the pose that will be displayed (sas)"},
};

template <class T>
std::optional<T> parse_number(std::string_view text) {
  T v{};
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, v);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return v;
}

bool is_choice(std::string_view choices, std::string_view text) {
  while (!choices.empty()) {
    const auto end = std::min(choices.find(' '), choices.size());
    if (choices.substr(0, end) == text) return true;
    choices.remove_prefix(std::min(end + 1, choices.size()));
  }
  return false;
}

bool assign(const Key& key, std::string_view text, std::string& out) {
  const bool printable =
      std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c != '\x7f'; });
  if (!printable || text.size() > 4096) return false;
  if (!key.choices.empty() && !is_choice(key.choices, text)) return false;
  out = text;
  return true;
}

bool assign(const Key&, std::string_view text, bool& out) {
  if (text != "true" && text != "false") return false;
  out = text == "true";
  return true;
}

bool assign(const Key& key, std::string_view text, Extent2D& out) {
  const auto extent = parse_extent(text);
  if (extent.has_error()) return false;
  const auto fits = [&](std::uint32_t side) { return side >= key.low && side <= key.high; };
  if (!fits(extent->width) || !fits(extent->height)) return false;
  out = *extent;
  return true;
}

template <class Number>
requires std::is_arithmetic_v<Number>
bool assign(const Key& key, std::string_view text, Number& out) {
  const auto v = parse_number<Number>(text);
  if (!v || !(static_cast<double>(*v) >= key.low && static_cast<double>(*v) <= key.high)) return false;
  out = *v == Number{} ? Number{} : *v;  // no negative zero
  return true;
}

/// Letters to insert, remove or replace, to suggest a key.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

std::string nearest_key(std::string_view name) {
  const auto nearest = std::min_element(kKeys.begin(), kKeys.end(), [&](const Key& a, const Key& b) {
    return edit_distance(a.name, name.substr(0, 64)) < edit_distance(b.name, name.substr(0, 64));
  });
  return std::string(nearest->name);
}

}  // namespace

std::span<const Key> keys() { return kKeys; }

const Key* find_key(std::string_view name) {
  const auto found = std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& k) { return k.name == name; });
  return found == kKeys.end() ? nullptr : &*found;
}

std::string allowed_text(const Key& key) {
  return std::visit(
      [&]<class T>(T PointSettings::*) -> std::string {
        if constexpr (std::is_same_v<T, bool>) {
          return "true or false";
        } else if constexpr (std::is_same_v<T, std::string>) {
          if (key.choices.empty()) return "text of one line";
          std::string list(key.choices);
          for (std::size_t at = 0; (at = list.find(' ', at)) != std::string::npos; at += 2) {
            list.replace(at, 1, ", ");
          }
          return "one of " + list;
        } else if constexpr (std::is_same_v<T, Extent2D>) {
          return fmt::format("WxH, sides {}..{}", key.low, key.high);
        } else {
          return fmt::format("{}{}..{}", std::is_integral_v<T> ? "a whole number " : "", key.low, key.high);
        }
      },
      key.member);
}

std::string value_text(const Key& key, const PointSettings& settings) {
  return std::visit(
      [&]<class T>(T PointSettings::*member) -> std::string {
        const T& v = settings.*member;
        if constexpr (std::is_same_v<T, Extent2D>) {
          return fmt::format("{}x{}", v.width, v.height);
        } else {
          return fmt::format("{}", v);
        }
      },
      key.member);
}

Result<void> set_value(const Key& key, std::string_view text, PointSettings& settings) {
  const bool ok = std::visit([&](auto member) { return assign(key, text, settings.*member); }, key.member);
  if (ok) return {};
  return Error{LabError::kOutOfRange,
               fmt::format("{} = {}: must be {}", key.name, text.substr(0, 80), allowed_text(key))};
}

Result<void> set_value(std::string_view name, std::string_view text, PointSettings& settings) {
  if (const Key* key = find_key(name)) return set_value(*key, text, settings);
  return Error{LabError::kUnknownKey,
               fmt::format("{} (did you mean {}?)", name.substr(0, 80), nearest_key(name))};
}

Result<void> check_together(const PointSettings& s) {
  const auto refuse = [](const std::string& what) { return Error{LabError::kOutOfRange, what}; };
  if (s.atlas.width % 64 != 0 || s.atlas.height % 64 != 0)
    return refuse(fmt::format("atlas = {}x{}: sides must be multiples of 64", s.atlas.width, s.atlas.height));
  if (s.grid_bits != 0 && s.grid_bits < 8)
    return refuse(fmt::format("grid_bits = {}: must be 0 or 8..20", s.grid_bits));
  if (!s.profile.empty() && s.latency_ms != 0)
    return refuse(fmt::format("latency_ms = {}: must be 0 with profile = {}", s.latency_ms, s.profile));
  if (const auto lens = render::parse_lens(s.lens); lens.has_error())
    return refuse(
        fmt::format("lens = {}: {}", s.lens.substr(0, 80), render::error_text(render::LensError::kBadLens)));
  if (s.scene.empty() || s.path.empty()) return refuse("scene and path must not be empty");
  return {};
}

std::vector<std::pair<std::string, std::string>> all_values(const PointSettings& settings) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const Key& key : kKeys) values.emplace_back(key.name, value_text(key, settings));
  return values;
}

}  // namespace atlaswire::lab

#include "render/scene/patch_grouping.h"

#include "render/scene/patch_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Two triangles that may share a patch.
struct Link {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float fit = 0;
};

/// A directed edge of a triangle, for pairing with its opposite.
struct HalfEdge {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t triangle = 0;
  bool ascending = false;
};

class Grouper {
 public:
  Grouper(const TriangleMesh& mesh, const PatchSettings& settings)
      : mesh_(mesh),
        settings_(settings),
        count_(static_cast<std::uint32_t>(mesh.indices.size() / 3)),
        partner_(count_, kNone),
        third_(count_, kNone) {}

  std::vector<TriangleGroup> run() {
    find_links();
    match_greedily();
    for (std::uint32_t t = 0; t < count_; ++t) {
      if (partner_[t] == kNone) augment(t);
    }
    attach_solos();
    return groups();
  }

 private:
  [[nodiscard]] std::array<std::uint32_t, 3> corners(std::uint32_t t) const {
    return {mesh_.indices[3 * t], mesh_.indices[3 * t + 1], mesh_.indices[3 * t + 2]};
  }
  [[nodiscard]] glm::vec3 at(std::uint32_t vertex) const { return mesh_.positions[vertex]; }
  [[nodiscard]] glm::vec3 normal(std::uint32_t t) const {
    const auto c = corners(t);
    return glm::cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0]));
  }

  /// The corner of `t` that neither `x` nor `y` is, or kNone when `t` does not have both.
  [[nodiscard]] std::uint32_t apex(std::uint32_t t, std::uint32_t x, std::uint32_t y) const {
    const auto c = corners(t);
    for (std::size_t i = 0; i < 3; ++i) {
      if ((c[(i + 1) % 3] == x && c[(i + 2) % 3] == y) || (c[(i + 1) % 3] == y && c[(i + 2) % 3] == x))
        return c[i];
    }
    return kNone;
  }

  /// Corners of the pair in patch order: the shared edge is 0-2.
  [[nodiscard]] std::array<std::uint32_t, 4> quad(std::uint32_t a, std::uint32_t b) const {
    const auto c = corners(a);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t last = apex(b, c[i], c[(i + 2) % 3]);
      // Triangle {0,1,2} = a from corner i on; its edge from 2 to 0 is the shared one.
      if (last != kNone && shares_edge(b, c[(i + 2) % 3], c[i]))
        return {c[i], c[(i + 1) % 3], c[(i + 2) % 3], last};
    }
    return {kNone, kNone, kNone, kNone};
  }

  /// Does `t` run along the edge from `to` to `from`, as a neighbour of the edge from..to should?
  [[nodiscard]] bool shares_edge(std::uint32_t t, std::uint32_t from, std::uint32_t to) const {
    const auto c = corners(t);
    for (std::size_t i = 0; i < 3; ++i) {
      if (c[i] == to && c[(i + 1) % 3] == from) return true;
    }
    return false;
  }

  void find_links() {
    std::vector<HalfEdge> edges;
    edges.reserve(mesh_.indices.size());
    for (std::uint32_t t = 0; t < count_; ++t) {
      const auto c = corners(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = c[i];
        const std::uint32_t to = c[(i + 1) % 3];
        edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
      }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
      return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
    });
    for (std::size_t first = 0; first < edges.size();) {
      std::size_t last = first + 1;
      while (last < edges.size() && edges[last].low == edges[first].low &&
             edges[last].high == edges[first].high)
        ++last;
      // A non-manifold fan of very many triangles on one edge would make a quadratic number of links.
      const std::size_t bound = std::min(last, first + 8);
      for (std::size_t i = first; i < bound; ++i) {
        for (std::size_t j = i + 1; j < bound; ++j) consider(edges[i], edges[j]);
      }
      first = last;
    }
    link_start_.assign(count_ + 1, 0);
    for (const Link& link : links_) {
      ++link_start_[link.a + 1];
      ++link_start_[link.b + 1];
    }
    for (std::uint32_t t = 0; t < count_; ++t) link_start_[t + 1] += link_start_[t];
    link_list_.resize(links_.size() * 2);
    std::vector<std::uint32_t> place(link_start_.begin(), link_start_.end() - 1);
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
      link_list_[place[links_[i].a]++] = i;
      link_list_[place[links_[i].b]++] = i;
    }
  }

  void consider(const HalfEdge& x, const HalfEdge& y) {
    if (x.triangle == y.triangle || x.ascending == y.ascending) return;
    if (mesh_.materials[x.triangle] != mesh_.materials[y.triangle]) return;
    if (bend(normal(x.triangle), normal(y.triangle)) > settings_.max_bend) return;
    const auto q = quad(x.triangle, y.triangle);
    if (q[0] == kNone) return;
    const double fit = quad_fit({at(q[0]), at(q[1]), at(q[2]), at(q[3])});
    if (fit < settings_.min_fit) return;
    links_.push_back({x.triangle, y.triangle, static_cast<float>(fit)});
  }

  void match_greedily() {
    std::vector<std::uint32_t> order(links_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [this](std::uint32_t x, std::uint32_t y) { return links_[x].fit > links_[y].fit; });
    for (const std::uint32_t i : order) {
      const Link& link = links_[i];
      if (partner_[link.a] == kNone && partner_[link.b] == kNone) pair(link.a, link.b);
    }
  }

  void pair(std::uint32_t a, std::uint32_t b) {
    partner_[a] = b;
    partner_[b] = a;
  }

  [[nodiscard]] std::span<const std::uint32_t> links_of(std::uint32_t t) const {
    return std::span(link_list_).subspan(link_start_[t], link_start_[t + 1] - link_start_[t]);
  }
  [[nodiscard]] std::uint32_t other(std::uint32_t link, std::uint32_t t) const {
    return links_[link].a == t ? links_[link].b : links_[link].a;
  }

  /// Breadth first along alternating paths from a solo triangle to another; re-pairs along the first found.
  void augment(std::uint32_t solo) {
    struct Step {
      std::uint32_t triangle;  ///< reached over a link, still paired with someone else
      std::uint32_t previous;  ///< index of the step before, kNone at the start
      std::uint32_t depth;
    };
    steps_seen_.clear();
    std::vector<Step> steps{{solo, kNone, 0}};
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
      for (const std::uint32_t link : links_of(steps[i].triangle)) {
        const std::uint32_t reached = other(link, steps[i].triangle);
        if (reached == solo ||
            std::find(steps_seen_.begin(), steps_seen_.end(), reached) != steps_seen_.end())
          continue;
        if (partner_[reached] == kNone) {
          // Unwind: each step's triangle pairs with what was reached from it.
          std::uint32_t mate = reached;
          for (std::uint32_t s = i; s != kNone; s = steps[s].previous) {
            const std::uint32_t old = partner_[steps[s].triangle];
            pair(steps[s].triangle, mate);
            mate = old;
          }
          return;
        }
        steps_seen_.push_back(reached);
        if (steps[i].depth < settings_.max_repairs && steps.size() < 64) {
          steps_seen_.push_back(partner_[reached]);
          steps.push_back({partner_[reached], i, steps[i].depth + 1});
        }
      }
    }
  }

  void attach_solos() {
    for (std::uint32_t t = 0; t < count_; ++t) {
      if (partner_[t] != kNone) continue;
      double best = settings_.min_fit;
      std::uint32_t host = kNone;
      for (const std::uint32_t link : links_of(t)) {
        const std::uint32_t a = other(link, t);
        const std::uint32_t b = partner_[a];
        if (b == kNone || third_[a] != kNone || third_[b] != kNone) continue;
        if (third_[std::min(a, b)] != kNone) continue;
        const double fit = fan(a, b, t).second;
        if (fit > best) {
          best = fit;
          host = a;
        }
      }
      if (host == kNone) continue;
      third_[host] = third_[partner_[host]] = t;
      attached_.push_back(t);
    }
  }

  /// The three triangles as a fan around corner 3, `middle` first in the search; fit 0 when they are none.
  [[nodiscard]] std::pair<std::array<std::uint32_t, 5>, double> fan(std::uint32_t a, std::uint32_t b,
                                                                    std::uint32_t c) const {
    std::pair<std::array<std::uint32_t, 5>, double> best{{kNone, kNone, kNone, kNone, kNone}, 0.0};
    const std::uint32_t triangles[3] = {a, b, c};
    // Triangles {0,1,3} {1,2,3} {0,3,4}: the first touches both others, across 1-3 and 3-0.
    for (std::uint32_t m = 0; m < 3; ++m) {
      const auto mc = corners(triangles[m]);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t p0 = mc[i];
        const std::uint32_t p1 = mc[(i + 1) % 3];
        const std::uint32_t p3 = mc[(i + 2) % 3];
        for (std::uint32_t flip = 0; flip < 2; ++flip) {
          const std::uint32_t right = triangles[(m + 1 + flip) % 3];
          const std::uint32_t left = triangles[(m + 2 - flip) % 3];
          if (!shares_edge(right, p1, p3) || !shares_edge(left, p3, p0)) continue;
          const std::uint32_t p2 = apex(right, p1, p3);
          const std::uint32_t p4 = apex(left, p3, p0);
          const double fit = fan_fit({at(p0), at(p1), at(p2), at(p3), at(p4)});
          if (fit > best.second) best = {{p0, p1, p2, p3, p4}, fit};
        }
      }
    }
    return best;
  }

  [[nodiscard]] TriangleGroup solo_group(std::uint32_t t) const {
    const auto c = corners(t);
    std::size_t square = 0;
    double best = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < 3; ++i) {
      const double off =
          std::abs(corner_angle(at(c[i]), at(c[(i + 1) % 3]), at(c[(i + 2) % 3])) - std::numbers::pi / 2);
      if (off < best) {
        best = off;
        square = i;
      }
    }
    const std::uint32_t last = c[(square + 2) % 3];
    return {{c[square], c[(square + 1) % 3], last, last, last}, t, 1};
  }

  [[nodiscard]] std::vector<TriangleGroup> groups() const {
    std::vector<bool> attached(count_, false);
    for (const std::uint32_t t : attached_) attached[t] = true;
    std::vector<TriangleGroup> out;
    for (std::uint32_t t = 0; t < count_; ++t) {
      if (attached[t]) continue;
      const std::uint32_t mate = partner_[t];
      if (mate == kNone) {
        out.push_back(solo_group(t));
      } else if (t < mate && third_[t] == kNone) {
        const auto q = quad(t, mate);
        out.push_back({{q[0], q[1], q[2], q[3], q[3]}, t, 2});
      } else if (t < mate) {
        out.push_back({fan(t, mate, third_[t]).first, std::min(t, third_[t]), 3});
      }
    }
    std::sort(out.begin(), out.end(),
              [](const TriangleGroup& x, const TriangleGroup& y) { return x.triangle < y.triangle; });
    return out;
  }

  const TriangleMesh& mesh_;
  const PatchSettings& settings_;
  std::uint32_t count_;
  std::vector<Link> links_;
  std::vector<std::uint32_t> link_start_;
  std::vector<std::uint32_t> link_list_;
  std::vector<std::uint32_t> partner_;
  std::vector<std::uint32_t> third_;
  std::vector<std::uint32_t> attached_;
  std::vector<std::uint32_t> steps_seen_;
};

}  // namespace

std::vector<TriangleGroup> group_triangles(const TriangleMesh& mesh, const PatchSettings& settings) {
  return Grouper(mesh, settings).run();
}

}  // namespace atlaswire::render

#include "texture_association.h"

#include <algorithm>
#include <cmath>

#include "ping_motion.h"

namespace s2s::calib {

namespace {

int floorDivided(int value, int by) { return value >= 0 ? value / by : -((-value + by - 1) / by); }

/// The sight of a place by the middle one of those pings of a group that see it.
std::optional<BedSight> middleSight(const std::vector<const PingMotion*>& motions, const BedProjector& projector,
                                    const Eigen::Vector3d& p_map, const Eigen::Vector2d& slope) {
  std::vector<BedSight> sights;
  for (const PingMotion* motion : motions)
    if (auto sight = projector.sightOf(p_map, slope, *motion)) sights.push_back(*sight);
  if (sights.empty()) return {};
  return sights[sights.size() / 2];
}

}  // namespace

int TextureAssociation::tilePixels() const {
  return std::max(8, static_cast<int>(std::lround(options_.texture.tile_m / options_.texture.pixel_m)));
}

void TextureAssociation::makeGroups(const CalibrationState& state, const BedProjector& projector) {
  groups_.clear();
  motions_.clear();
  const core::TimeNs length = core::durationNs(options_.texture.group_s);
  std::vector<BedPicture::Sample> samples;
  const auto finish = [&] {
    if (!groups_.empty() && groups_.back().picture.empty()) groups_.back().picture.make(samples, options_.texture);
    samples.clear();
  };
  for (const TexturePing& ping : evidence_.texture) {
    const auto motion = pingMotionAt(evidence_.T_map_vehicle, ping.time, state[SonarId::Horizontal]);
    if (!motion) continue;
    if (groups_.empty() || ping.time >= groups_.back().time + length) {
      finish();
      groups_.push_back({ping.time, {}, BedPicture(options_.texture.pixel_m)});
    }
    motions_.push_back(std::make_unique<PingMotion>(*motion));
    groups_.back().motions.push_back(motions_.back().get());
    projector.project(ping, *motion, samples);
  }
  finish();
}

std::map<TextureAssociation::TileIndex, std::vector<std::size_t>> TextureAssociation::groupsOfTiles() const {
  std::map<TileIndex, std::vector<std::size_t>> tiles;
  const int size = tilePixels();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const BedPicture& picture = groups_[g].picture;
    if (picture.empty()) continue;
    for (int y = floorDivided(picture.y0(), size); y <= floorDivided(picture.y0() + picture.height(), size); ++y)
      for (int x = floorDivided(picture.x0(), size); x <= floorDivided(picture.x0() + picture.width(), size); ++x)
        if (knownShare(picture, {x * size, y * size, size}) >= options_.texture.minOverlap) tiles[{x, y}].push_back(g);
  }
  return tiles;
}

void TextureAssociation::compare(const TileIndex& tile, const std::vector<std::size_t>& groups,
                                 const BedProjector& projector, const CalibrationState& state, SeabedGrid& grid,
                                 double reach_m) {
  const TextureOptions& o = options_.texture;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < groups.size(); ++i)
    for (std::size_t j = i + 1; j < groups.size(); ++j)
      if (core::secondsBetween(groups_[groups[i]].time, groups_[groups[j]].time) >= o.minGap_s)
        pairs.emplace_back(groups[i], groups[j]);
  const std::size_t taken = std::min(pairs.size(), static_cast<std::size_t>(o.pairsPerTile));
  const int size = tilePixels();
  for (std::size_t k = 0; k < taken; ++k) {
    const auto& [i, j] = pairs[k * pairs.size() / taken];
    const auto match = matchPictures(groups_[i].picture, groups_[j].picture,
                                     {tile.first * size, tile.second * size, size}, reach_m, o);
    if (match && match->correlation >= o.minCorrelation && match->correlation >= o.minDistinctness * match->next)
      add(groups_[i], groups_[j], *match, projector, state, grid);
    else
      ++leftOut_;
  }
}

void TextureAssociation::add(const Group& first, const Group& second, const PictureMatch& match,
                             const BedProjector& projector, const CalibrationState& state, SeabedGrid& grid) {
  const Eigen::Vector2d at = match.centre_m, there = at + match.displacement_m;
  const auto bed = grid.at(at.x(), at.y()), bedThere = grid.at(there.x(), there.y());
  if (!bed || !bedThere) return;
  UsedTexture used;
  const double quarter = 0.25 * options_.texture.tile_m;
  const double signs[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  for (std::size_t n = 0; n < 4; ++n) {
    used.nodes[n] = grid.nearestNode(at.x() + quarter * signs[n][0], at.y() + quarter * signs[n][1]);
    if (!used.nodes[n]) return;
    used.residual.bed.nodes_m[n] = *used.nodes[n];
  }
  auto& plane = used.residual.bed;
  plane.centre_m = at;
  plane.height_m = bed->height_m;
  plane.slope = Eigen::Vector2d(plane.nodes_m[1] + plane.nodes_m[3] - plane.nodes_m[0] - plane.nodes_m[2],
                                plane.nodes_m[2] + plane.nodes_m[3] - plane.nodes_m[0] - plane.nodes_m[1]) /
                (4 * quarter);
  const Eigen::Vector3d p(at.x(), at.y(), plane.height_m);
  const Eigen::Vector3d q(there.x(), there.y(), plane.height_m + plane.slope.dot(match.displacement_m));
  const auto a = middleSight(first.motions, projector, p, plane.slope);
  const auto b = middleSight(second.motions, projector, q, plane.slope);
  if (!a || !b) return;
  used.residual.first = *a;
  used.residual.second = *b;
  used.residual.sonar = &state[SonarId::Horizontal];
  used.apart_m = match.displacement_m.norm();
  used.block = std::max(
      0, static_cast<int>(core::secondsBetween(evidence_.T_map_vehicle.front().time, first.time) / options_.block_s));
  used_.push_back(used);
}

void TextureAssociation::update(const CalibrationState& state, SeabedGrid& grid, double reach_m) {
  used_.clear();
  leftOut_ = 0;
  const BedProjector projector(state, grid, options_.texture);
  makeGroups(state, projector);
  for (const auto& [tile, groups] : groupsOfTiles()) compare(tile, groups, projector, state, grid, reach_m);
}

}  // namespace s2s::calib

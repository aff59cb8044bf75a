#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "bed_picture.h"
#include "bed_projector.h"
#include "s2s/calib/evidence.h"
#include "s2s/calib/options.h"

namespace s2s::calib {

/// A piece of the bed that two groups of pings both show.
struct UsedTexture {
  TextureResidual residual;
  std::array<double*, 4> nodes{};  ///< heights that the piece follows
  double apart_m = 0;              ///< by the present mounting
  int block = 0;                   ///< of time
};

/// Finds pieces of the bed again in pictures that the horizontal sonar took from elsewhere.
class TextureAssociation {
 public:
  TextureAssociation(const CalibrationEvidence& evidence, const CalibrationOptions& options)
      : evidence_(evidence), options_(options) {}

  /// Makes all pictures anew and compares them. What was found before is void.
  void update(const CalibrationState& state, SeabedGrid& grid, double reach_m);

  const std::vector<UsedTexture>& used() const { return used_; }
  std::size_t leftOut() const { return leftOut_; }

 private:
  /// Pings of a short time, and the picture they make together.
  struct Group {
    core::TimeNs time = 0;
    std::vector<const PingMotion*> motions;
    BedPicture picture;
  };
  using TileIndex = std::pair<int, int>;
  void makeGroups(const CalibrationState& state, const BedProjector& projector);
  std::map<TileIndex, std::vector<std::size_t>> groupsOfTiles() const;
  void compare(const TileIndex& tile, const std::vector<std::size_t>& groups, const BedProjector& projector,
               const CalibrationState& state, SeabedGrid& grid, double reach_m);
  void add(const Group& first, const Group& second, const PictureMatch& match, const BedProjector& projector,
           const CalibrationState& state, SeabedGrid& grid);
  int tilePixels() const;

  const CalibrationEvidence& evidence_;
  const CalibrationOptions& options_;
  std::vector<std::unique_ptr<PingMotion>> motions_;
  std::vector<Group> groups_;
  std::vector<UsedTexture> used_;
  std::size_t leftOut_ = 0;
};

}  // namespace s2s::calib

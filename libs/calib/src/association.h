#pragma once

#include <array>
#include <memory>
#include <vector>

#include "aperture_association.h"
#include "calibration_problem.h"

namespace s2s::calib {

/// How far evidence may be off in a round.
struct RoundGates {
  double echo_m = 1;      ///< echoes from seabed and walls
  double texture_m = 0;   ///< how far apart pictures of the bed may be; 0: they are not looked at
  bool aperture = false;  ///< whether the ends of the aperture are looked for
  bool mirror = false;    ///< whether the second echoes by way of the water surface are looked for
};

/// Finds, by the mountings known by now, which surface each echo belongs to.
class Association {
 public:
  Association(const CalibrationEvidence& evidence, const CalibrationOptions& options);

  /// Places all evidence, fits the seabed to it, gates and weighs.
  /// @throws core::InputError if there are too few echoes
  void update(const CalibrationState& state, SeabedGrid& grid, const RoundGates& gates);

  const RoundEvidence& used() const { return used_; }
  CalibrationStatistics statistics() const;

 private:
  struct PlacedEcho {
    UsedEcho used;
    Eigen::Vector3d p_map, p_farther_map;      ///< p_farther: a metre further out
    std::optional<Eigen::Vector3d> other_map;  ///< of a band: its other point
    bool mayBeSeabed = true;
  };
  const PingMotion* motionOf(core::TimeNs recorded, const SonarState& sonar);
  int blockOf(core::TimeNs time) const;
  void placeEchoes(const CalibrationState& state);
  void placeEcho(const Echo& echo, const UsedEcho& common, const CalibrationState& state);
  bool placeAtWall(PlacedEcho& placed, const CalibrationState& state) const;
  void fitGrid(SeabedGrid& grid) const;
  void associateEchoes(const SeabedGrid& grid, double gate_m);
  std::optional<double> gapOfOther(PlacedEcho& placed, const SeabedGrid& grid) const;
  bool associateWithWall(PlacedEcho& placed, const SeabedGrid& grid, double gate_m);
  void findDepth(const CalibrationState& state);
  void findAperture(const CalibrationState& state, const SeabedGrid& grid);
  void findTexture(const CalibrationState& state, SeabedGrid& grid, double reach_m);
  void rescale();

  const CalibrationEvidence& evidence_;
  const CalibrationOptions& options_;
  std::size_t stride_ = 1;
  std::vector<std::unique_ptr<PingMotion>> motions_;
  std::vector<PlacedEcho> echoes_;
  ApertureAssociation aperture_;
  TextureAssociation texture_;
  RoundEvidence used_;
  std::optional<MirrorDepth> depth_;
  std::array<double, kEvidenceKinds> sigma_{};  ///< metres
  std::array<std::size_t, kEvidenceKinds> counts_{}, leftOut_{};
  std::array<std::vector<double>, kEvidenceKinds> spreads_;
};

}  // namespace s2s::calib

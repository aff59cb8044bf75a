#pragma once

#include <random>
#include <vector>

#include "s2s/calib/calibrator.h"
#include "s2s/sonar/ping_geometry.h"

namespace s2s::calib::test {

/// A survey without pictures: echoes of a seabed given by a formula, met exactly as the measurement model says.
struct IdealSurvey {
  CalibrationState truth;
  CalibrationState nominal;
  CalibrationEvidence evidence;
};

/// Time of a survey's first pose.
constexpr core::TimeNs kStart = 1'733'400'000'000'000'000;

struct IdealSurveyOptions {
  bool relief = true;  ///< else a level bed
  bool turns = true;   ///< a figure eight sailed both ways, else a straight run
  bool waves = true;   ///< roll, pitch and heave
  double noise_m = 0.01;
  double duration_s = 120;
  core::Isometry error_h = core::Isometry::Identity(),
                 error_v = core::Isometry::Identity();  ///< true = nominal * error
  double late_h_s = 0, late_v_s = 0;
  double wall_y_m = 0;  ///< a wall along x, seen by LiDAR and horizontal sonar; 0: none
};

inline double reliefAt(const IdealSurveyOptions& o, double x, double y) {
  if (!o.relief) return -3.5;
  return -3.5 + 0.25 * std::sin(0.9 * x + 0.3 * y) + 0.2 * std::cos(0.5 * x - 1.1 * y) + 0.1 * std::sin(1.7 * y + 0.4);
}

/// Vehicle's pose. Turning: a figure eight of 8 m by 4 m, half of the time the one way, then the other.
inline core::Isometry poseAt(const IdealSurveyOptions& o, double t_s) {
  double x = 1.2 * t_s, y = 0, yaw = 0;
  if (o.turns) {
    const double half = 0.5 * o.duration_s, u = t_s < half ? t_s : 2 * half - t_s, w = 2 * M_PI / 30;
    const double direction = t_s < half ? 1 : -1;
    x = 6 * std::sin(w * u), y = 3 * std::sin(2 * w * u);
    yaw = std::atan2(direction * 6 * w * std::cos(2 * w * u), direction * 6 * w * std::cos(w * u));
  }
  const double sway = o.waves ? 0.04 : 0;
  return core::isometryFromXyzYpr(x, y, 0.5 * sway * std::sin(2.9 * t_s), yaw, sway * std::sin(3.3 * t_s),
                                  sway * std::cos(4.1 * t_s));
}

/// Elevation [rad] at which the arc of a range and a bearing meets the bed, from a guess.
inline double elevationOf(const IdealSurveyOptions& o, const core::Isometry& T, double r, double bearing,
                          double guess) {
  const auto height = [&](double e) {
    const Eigen::Vector3d p = T * sonar::pointAt({r, bearing, e}, obs::BearingModel::Azimuth);
    return p.z() - reliefAt(o, p.x(), p.y());
  };
  for (int k = 0; k < 4; ++k) guess -= height(guess) * 1e-3 / (height(guess + 1e-3) - height(guess));
  return guess;
}

/// Range at which the ray of a bearing and an elevation meets the bed; 0 if it does not within 12 m.
inline double castRange(const IdealSurveyOptions& o, const core::Isometry& T_map_sonar, double bearing,
                        double elevation) {
  const auto height = [&](double r) {
    const Eigen::Vector3d p = T_map_sonar * sonar::pointAt({r, bearing, elevation}, obs::BearingModel::Azimuth);
    return p.z() - reliefAt(o, p.x(), p.y());
  };
  double lower = 0.5;
  for (double r = 0.6; r < 12; r += 0.1) {
    if (height(r) > 0) {
      lower = r;
      continue;
    }
    double upper = r;
    for (int k = 0; k < 30; ++k) (height(0.5 * (lower + upper)) > 0 ? lower : upper) = 0.5 * (lower + upper);
    return lower;
  }
  return 0;
}

/// Range at which the arc of a bearing touches the wall from the side of smaller y, if it does so within the aperture,
/// below the water and well above the bed; else 0.
inline double wallRange(const IdealSurveyOptions& o, const core::Isometry& T_map_sonar, double bearing,
                        double halfAperture) {
  double most = 0, at = 0;
  for (double e = -halfAperture; e <= halfAperture; e += 1e-3) {
    const double across = (T_map_sonar.linear() * sonar::pointAt({1, bearing, e}, obs::BearingModel::Azimuth)).y();
    if (across > most) most = across, at = e;
  }
  if (most < 0.3 || std::abs(at) > 0.8 * halfAperture) return 0;
  const double r = (o.wall_y_m - T_map_sonar.translation().y()) / most;
  const Eigen::Vector3d p = T_map_sonar * sonar::pointAt({r, bearing, at}, obs::BearingModel::Azimuth);
  return r < 10 && p.z() < -0.3 && p.z() > reliefAt(o, p.x(), p.y()) + 0.5 ? r : 0;
}

inline IdealSurvey idealSurvey(const IdealSurveyOptions& o) {
  IdealSurvey survey;
  auto& nominal = survey.nominal;
  nominal[SonarId::Horizontal].T_vehicle_sonar = core::isometryFromXyzYpr(-1.1, 0, -0.45, 0, M_PI / 4, 0);
  nominal[SonarId::Vertical].T_vehicle_sonar = core::isometryFromXyzYpr(-1.13, -0.14, -0.58, 0, M_PI / 4, M_PI / 2);
  for (auto& sonar : nominal.sonars) {
    sonar.aperture_rad = 20 * M_PI / 180;
    sonar.deviceSoundSpeed_mps = 1480;
  }
  survey.truth = nominal;
  survey.truth[SonarId::Horizontal].T_vehicle_sonar = nominal[SonarId::Horizontal].T_vehicle_sonar * o.error_h;
  survey.truth[SonarId::Vertical].T_vehicle_sonar = nominal[SonarId::Vertical].T_vehicle_sonar * o.error_v;

  std::vector<core::TimedPose> poses;
  for (double t_s = -1; t_s < o.duration_s + 1; t_s += 0.01)
    poses.push_back({kStart + core::durationNs(t_s), poseAt(o, t_s)});
  survey.evidence.T_map_vehicle = core::Trajectory(std::move(poses));

  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, o.noise_m);
  for (int n = 0; n < static_cast<int>(10 * o.duration_s); ++n)
    for (const SonarId id : kSonars) {
      const double t_s = 0.1 * n, late_s = id == SonarId::Horizontal ? o.late_h_s : o.late_v_s;
      PingEchoes ping;
      ping.sonar = id;
      ping.time = kStart + core::durationNs(t_s + late_s);
      const core::Isometry T = poseAt(o, t_s) * survey.truth[id].T_vehicle_sonar;
      const double half = 0.5 * nominal[id].aperture_rad;
      const auto add = [&](double bearing, EchoKind kind, double share) {
        if (const double r = castRange(o, T, bearing, share * half); r > 0)
          ping.echoes.push_back(
              {static_cast<float>(bearing), static_cast<float>(r + noise(random)), kind, static_cast<float>(share)});
      };
      if (id == SonarId::Vertical)
        for (int b = -6; b <= 6; ++b) add(0.06 * b, EchoKind::Middle, (b % 2 ? 1 : -1) / std::sqrt(3.0));
      else
        for (int b = -8; b <= 8; ++b) {
          add(0.09 * b, EchoKind::NearEdge, -1);
          add(0.09 * b, EchoKind::FarEdge, 1);
          if (const double r = o.wall_y_m != 0 ? wallRange(o, T, 0.12 * b, half) : 0; r > 0)
            ping.echoes.push_back(
                {static_cast<float>(0.12 * b), static_cast<float>(r + noise(random)), EchoKind::Ridge, 0});
        }
      survey.evidence.pings.push_back(std::move(ping));
    }
  if (o.wall_y_m != 0)
    survey.evidence.wallAt = [y = o.wall_y_m](double, double y_m) -> std::optional<WallPlane> {
      if (std::abs(y_m - y) > 1) return {};
      return WallPlane{Eigen::Vector2d::UnitY(), y};
    };
  return survey;
}

}  // namespace s2s::calib::test

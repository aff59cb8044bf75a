#include "s2s/calib/calibration_report.h"

#include <mrpt/core/format.h>

#include "s2s/calib/ini_patch.h"
#include "s2s/core/option_table.h"

namespace s2s::calib {

namespace {

constexpr double kDegrees = 180 / M_PI;
const char* const kRow = "  %-24s %10s %10s %9s  %s\n";

/// A parameter's value in the unit it is shown in.
struct Unit {
  double scale;
  const char* name;
  int digits;
};

Unit unitOf(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::Position:
      return {1, "m", 4};
    case ParameterKind::Rotation:
      return {kDegrees, "deg", 3};
    case ParameterKind::Time:
      return {1e3, "ms", 2};
    case ParameterKind::SoundSpeed:
      break;
  }
  return {1, "m/s", 2};
}

std::string number(double value, int digits) {
  const std::string text = mrpt::format("%.*f", digits, value);
  return text.find_first_not_of("-0.") == std::string::npos && text[0] == '-' ? text.substr(1) : text;
}

std::string row(const std::string& name, const Unit& unit, double before, double after, const ParameterVerdict& v) {
  const std::string verdict = v.verdict == Verdict::Observable ? "observable"
                              : v.verdict == Verdict::Rough    ? "rough estimate"
                                                               : "NOT OBSERVABLE: " + v.why;
  return mrpt::format(kRow, (name + " [" + unit.name + "]").c_str(), number(before * unit.scale, unit.digits).c_str(),
                      number(after * unit.scale, unit.digits).c_str(),
                      number(v.sigma * unit.scale, unit.digits).c_str(), verdict.c_str());
}

double nominalOf(const CalibrationState& state, int parameter) {
  if (parameter == kWanted - 1) return state.nominalSoundSpeed_mps;
  const auto& sonar = state.sonars[static_cast<std::size_t>(parameter / kWantedSonarParameters)];
  const int own = parameter % kWantedSonarParameters;
  if (own == kTime) return sonar.timeOffset_s;
  return own < kRotX ? sonar.T_vehicle_sonar.translation()[own] : 0;  // turns are relative to the nominal mounting
}

bool isAngle(std::size_t kind) { return kind == static_cast<std::size_t>(EvidenceKind::Aperture); }

std::string poses(const CalibrationState& state) {
  std::string text;
  for (const SonarId id : kSonars)
    text += mrpt::format("  %-10s  old  %s\n  %-10s  new  %s\n", sonarName(id),
                         core::printPose(state[id].T_vehicle_sonar).c_str(), "",
                         core::printPose(state[id].corrected()).c_str());
  return text;
}

bool anyMoved(const SonarState& sonar) {
  for (int i = 0; i < kTime; ++i)
    if (sonar.correction[static_cast<std::size_t>(i)] != 0) return true;
  return false;
}

}  // namespace

std::string reportText(const CalibrationResult& result) {
  const auto& o = result.observability;
  const WantedVector x = correctionsOf(result.state);
  std::string text = "Mountings (x y z [m] yaw pitch roll [deg])\n" + poses(result.state) + "\n";
  text += mrpt::format(kRow, "parameter", "old", "new", "sigma", "verdict");
  for (int i = 0; i < kWanted; ++i) {
    const double before = nominalOf(result.state, i);
    text += row(parameterName(i), unitOf(kindOf(i)), before, before + x[i], o.parameters[static_cast<std::size_t>(i)]);
  }
  text += "\nThe vertical sonar's less the horizontal one's\n";
  static const char* const kNames[] = {"x", "y", "z", "time offset"};
  const int own[] = {kX, kY, kZ, kTime};
  for (std::size_t k = 0; k < o.relative.size(); ++k) {
    const int h = own[k], v = own[k] + kWantedSonarParameters;
    const double before = nominalOf(result.state, v) - nominalOf(result.state, h);
    text += row(kNames[k], unitOf(kindOf(h)), before, before + x[v] - x[h], o.relative[k]);
  }
  static const char* const kKinds[kEvidenceKinds] = {"near edges",     "far edges", "upright bands",  "ridges of walls",
                                                     "bands at walls", "texture",   "aperture's ends"};
  text += "\n";
  for (std::size_t k = 0; k < kEvidenceKinds; ++k)
    text += mrpt::format("  %-15s %7zu used, %7zu left out, spread %.3f %s\n", kKinds[k], result.statistics.used[k],
                         result.statistics.leftOut[k], result.statistics.sigma_m[k] * (isAngle(k) ? kDegrees : 1),
                         isAngle(k) ? "deg" : "m");
  if (const auto& mirror = result.statistics.mirror)
    text += mrpt::format("  echoes by way of the water surface: %zu traces, strength %.2f, %.0f %% explained\n",
                         mirror->traces, mirror->strength, 100 * mirror->explained);
  else
    text += "  echoes by way of the water surface: none; the height of both sonars needs a bar check\n";
  for (const SonarId id : kSonars)
    text += mrpt::format("  %-10s aperture %+.2f deg (near edge) %+.2f deg (far edge), ranges %+.4f m\n", sonarName(id),
                         result.state[id].correction[kNear] * kDegrees, result.state[id].correction[kFar] * kDegrees,
                         result.state[id].correction[kRange]);
  return text;
}

std::string calibratedIni(const std::string& text, const CalibrationResult& result) {
  std::string ini = text;
  for (const SonarId id : kSonars) {
    const SonarState& sonar = result.state[id];
    const std::string name = std::string("sonar_") + sonarName(id);
    if (anyMoved(sonar)) ini = patchedIni(ini, "mapper", "pose_" + name, core::printPose(sonar.corrected()));
    if (sonar.correction[kTime] != 0)
      ini = patchedIni(ini, "mapper", "time_offset_" + name + "_s", core::printDouble(sonar.correctedTimeOffset_s()));
  }
  if (result.observability.parameters[kWanted - 1].verdict != Verdict::Unobservable)
    ini = patchedIni(ini, "mapper", "sound_speed_mps", core::printDouble(result.state.soundSpeed_mps));
  return ini;
}

}  // namespace s2s::calib

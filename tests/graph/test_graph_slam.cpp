#include <gtest/gtest.h>

#include "s2s/core/error.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using namespace s2s::graph::test;

namespace {

/// Options for the synthetic surveys, whose odometry is exactly as good as its covariance says.
GraphSlamOptions honestOdometry() {
  GraphSlamOptions options;
  options.consistency.driftTranslation_m = 1e-4;
  options.consistency.driftRotation_rad = 1e-5;
  options.loops.enabled = false;
  return options;
}

void addAll(GraphSlam& slam, const SyntheticSurvey& survey) {
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) slam.addKeyframe(keyframeInput(survey, k));
}

/// A true closure with 2 cm and 1 mrad of noise, every `every` keyframes of the second lap.
void offerTrueClosures(GraphSlam& slam, const SyntheticSurvey& survey, int every, FixedRandom& random) {
  const int round = static_cast<int>(survey.truth.size()) / 2;
  for (int k = 0; k < round; k += every) {
    const core::Isometry T = survey.truth[k].inverse() * survey.truth[k + round];
    slam.offerClosure(k, k + round, perturbed(T, random.normal6(0.02, 0.001)), diagonalCovariance(0.02, 0.001));
  }
}

std::vector<Eigen::Vector3d> positions(const GraphSlam& slam) {
  std::vector<Eigen::Vector3d> result;
  for (const auto& keyframe : slam.keyframes()) result.push_back(keyframe.T_map_vehicle.translation());
  return result;
}

double largestDifference_m(const GraphSlam& a, const GraphSlam& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.keyframes().size(); ++k)
    largest = std::max(largest, (positions(a)[k] - positions(b)[k]).norm());
  return largest;
}

}  // namespace

TEST(GraphSlam, OdometryOnly_KeepsItsPoses) {
  const SyntheticSurvey survey = makeLaps(1, 60, 30, 111);
  GraphSlam slam(honestOdometry());
  addAll(slam, survey);
  slam.optimizeNow();
  for (const auto& keyframe : slam.keyframes())
    EXPECT_LT((keyframe.T_map_vehicle.translation() - survey.odometry[keyframe.id].translation()).norm(), 1e-6);
  EXPECT_EQ(slam.network().nodeCount(), survey.odometry.size());
  EXPECT_EQ(slam.network().edgeCount(), survey.odometry.size() - 1);
}

TEST(GraphSlam, TrueClosures_LowerTheError) {
  const SyntheticSurvey survey = makeLaps(2, 100, 50, 112);
  GraphSlam slam(honestOdometry());
  addAll(slam, survey);
  const double before_m = rmsError_m(slam, survey);
  FixedRandom random(113);
  offerTrueClosures(slam, survey, 10, random);
  slam.optimizeNow();
  EXPECT_LT(rmsError_m(slam, survey), 0.6 * before_m);
  // Of 30 honest closures hardly any fails a 99.9 % gate.
  EXPECT_GE(slam.statistics().accepted, 28);
}

TEST(GraphSlam, ThirtyPercentWrongClosures_ChangeLessThanOneCentimetre) {
  const SyntheticSurvey survey = makeLaps(2, 100, 50, 114);
  GraphSlam clean(honestOdometry()), attacked(honestOdometry());
  addAll(clean, survey);
  addAll(attacked, survey);
  FixedRandom closureNoise(115), sameNoise(115), random(116);
  // 20 wrong beside 30 true: some wild, some plausible within metres, some repeating the same wrong shift.
  for (int n = 0; n < 20; ++n) {
    const int from = static_cast<int>(random.uniform(0, 290)), to = from + 300;
    core::Vector6 error;
    if (n % 3 == 0)
      error = random.normal6(30, 1);
    else if (n % 3 == 1)
      error = random.normal6(2, 0.05);
    else
      error << 6, 0, 0, 0, 0, 0;
    const core::Isometry T = perturbed(survey.truth[from].inverse() * survey.truth[to], error);
    attacked.offerClosure(from, to, T, diagonalCovariance(0.02, 0.001));
  }
  offerTrueClosures(clean, survey, 10, closureNoise);
  offerTrueClosures(attacked, survey, 10, sameNoise);
  clean.optimizeNow();
  attacked.optimizeNow();
  EXPECT_LT(std::abs(rmsError_m(attacked, survey) - rmsError_m(clean, survey)), 0.01);  // the promise
  EXPECT_LT(largestDifference_m(attacked, clean), 0.05);
  for (const auto& closure : attacked.loopClosures()) {
    const core::Isometry truth = survey.truth[closure.from].inverse() * survey.truth[closure.to];
    const bool wrong = difference(truth, closure.T_from_to).norm() > 0.5;
    EXPECT_FALSE(wrong && closure.status == ClosureStatus::accepted) << closure.from << " " << closure.to;
  }
}

TEST(GraphSlam, LoneWrongClosure_ChangesNothing) {
  const SyntheticSurvey survey = makeLaps(1, 100, 50, 117);
  GraphSlam slam(honestOdometry());
  addAll(slam, survey);
  core::Isometry T = survey.odometry[10].inverse() * survey.odometry[250];
  T.translation().x() += 0.3;  // within the odometry's drift: only a second closure could tell
  const ClosureStatus status = slam.offerClosure(10, 250, T, diagonalCovariance(0.02, 0.001));
  EXPECT_NE(status, ClosureStatus::accepted);
  slam.optimizeNow();
  EXPECT_LT((slam.keyframes()[250].T_map_vehicle.translation() - survey.odometry[250].translation()).norm(), 1e-6);
}

namespace {

/// One lap through a town and 15 m of the next, the odometry off by 0.6 % of scale and a slow turn: drift that white
/// noise does not have.
SyntheticSurvey driftingLap() {
  SyntheticSurvey survey = makeLaps(1, 60, 40, 119);
  const SyntheticSurvey more = makeLaps(2, 60, 40, 119);
  survey.truth.assign(more.truth.begin(), more.truth.begin() + 215);
  survey.odometry.assign(more.odometry.begin(), more.odometry.begin() + 215);
  for (std::size_t k = 1; k < survey.odometry.size(); ++k) {
    core::Isometry step = survey.truth[k - 1].inverse() * survey.truth[k];
    step.translation() *= 1.006;
    step.linear() = step.linear() * core::expSo3(Eigen::Vector3d(0, 0, 0.0001));
    survey.odometry[k] = survey.odometry[k - 1] * step;
  }
  return survey;
}

void surveyTown(GraphSlam& slam, const SyntheticSurvey& survey) {
  const SyntheticTown town(60, 40, 118);
  FixedRandom random(120);
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    KeyframeInput input = keyframeInput(survey, k);
    input.cloud_vehicle = town.scan(survey.truth[k], 40, random);
    slam.addKeyframe(input);
  }
  slam.optimizeNow();
}

}  // namespace

TEST(GraphSlam, RevisitedTown_IsClosedByItself) {
  const SyntheticSurvey survey = driftingLap();
  GraphSlam slam;
  surveyTown(slam, survey);
  EXPECT_GE(slam.statistics().accepted, 3);
  for (const auto& closure : slam.loopClosures()) {
    if (closure.status != ClosureStatus::accepted) continue;
    const core::Isometry truth = survey.truth[closure.from].inverse() * survey.truth[closure.to];
    EXPECT_LT(difference(truth, closure.T_from_to).head<3>().norm(), 0.03);  // registration of 1 cm points
  }
  // The end of the lap lies where it was at the start, as far as the closures know it.
  const core::Isometry estimated = slam.keyframes()[5].T_map_vehicle.inverse() * slam.keyframes()[205].T_map_vehicle;
  EXPECT_LT((survey.truth[5].inverse() * survey.truth[205]).inverse().operator*(estimated).translation().norm(), 0.05);
}

TEST(GraphSlam, TownWithFalseClosuresAmongTheCandidates_IsMappedAsWithout) {
  const SyntheticSurvey survey = driftingLap();
  GraphSlam clean;
  surveyTown(clean, survey);
  for (const int seed : {1, 2, 3}) {
    GraphSlamOptions options;
    options.falseClosures.share = 0.3;
    options.falseClosures.seed = seed;
    GraphSlam attacked(options);
    surveyTown(attacked, survey);
    int injected = 0;
    for (const auto& closure : attacked.loopClosures()) {
      if (closure.source != ClosureSource::injected) continue;
      ++injected;
      EXPECT_NE(closure.status, ClosureStatus::accepted) << closure.from << " " << closure.to;
    }
    EXPECT_GE(injected, 2) << seed;
    EXPECT_LT(std::abs(rmsError_m(attacked, survey) - rmsError_m(clean, survey)), 0.01) << seed;  // the promise
  }
}

TEST(GraphSlam, SpoofedGnss_LeavesTheMapWhereItWasAndIsReported) {
  const SyntheticSurvey survey = makeLaps(2, 100, 50, 121);
  GraphSlamOptions withGnss = honestOdometry();
  withGnss.gnss.enabled = true;
  GraphSlam alone(honestOdometry()), spoofed(withGnss);
  FixedRandom random(122), noiseA(123), noiseB(123);
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    alone.addKeyframe(keyframeInput(survey, k));
    spoofed.addKeyframe(keyframeInput(survey, k));
    GnssFix fix;
    fix.time = keyframeInput(survey, k).time;
    fix.T_odom_vehicle = survey.odometry[k];
    const double walked_m = 50 * std::clamp((static_cast<double>(k) - 300) / 250, 0.0, 1.0);
    fix.p_enu = survey.truth[k].translation() + random.normal3(1) + Eigen::Vector3d(0, walked_m, 0);
    spoofed.addGnss(fix);
  }
  offerTrueClosures(alone, survey, 10, noiseA);
  offerTrueClosures(spoofed, survey, 10, noiseB);
  alone.optimizeNow();
  spoofed.optimizeNow();
  EXPECT_EQ(spoofed.gnssReport().state, GnssState::distrusted);
  EXPECT_GT(spoofed.gnssReport().largestDeviation_m, 40);
  EXPECT_LT(std::abs(rmsError_m(spoofed, survey) - rmsError_m(alone, survey)), 0.01);  // the promise
  EXPECT_LT(largestDifference_m(spoofed, alone), 0.01);
}

TEST(GraphSlam, HonestGnss_HoldsALongDrift) {
  SyntheticSurvey survey = makeLaps(1, 400, 100, 124);
  GraphSlamOptions options = honestOdometry();
  options.gnss.enabled = true;
  GraphSlam slam(options);
  FixedRandom random(125);
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    slam.addKeyframe(keyframeInput(survey, k));
    GnssFix fix;
    fix.T_odom_vehicle = survey.odometry[k];
    fix.sigma_m = Eigen::Vector3d::Constant(0.5);
    fix.p_enu = survey.truth[k].translation() + random.normal3(0.5);
    slam.addGnss(fix);
  }
  const double before_m = rmsError_m(slam, survey);
  slam.optimizeNow();
  EXPECT_EQ(slam.gnssReport().state, GnssState::trusted);
  ASSERT_TRUE(slam.gnssReport().T_enu_map);
  // The map stays at its first keyframe; compare in the frame of the fixes.
  double sum = 0;
  for (const auto& keyframe : slam.keyframes())
    sum +=
        (*slam.gnssReport().T_enu_map * keyframe.T_map_vehicle.translation() - survey.truth[keyframe.id].translation())
            .squaredNorm();
  EXPECT_LT(std::sqrt(sum / survey.truth.size()), 0.7 * before_m);
}

TEST(GraphSlam, Gravity_HoldsRollAndPitch) {
  SyntheticSurvey survey = makeLaps(2, 100, 50, 126);
  GraphSlamOptions options = honestOdometry();
  options.gravityCorrelation_s = 0;  // here every keyframe has an error of its own
  GraphSlam slam(options);
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    KeyframeInput input = keyframeInput(survey, k);
    input.gravity = GravityMeasurement{survey.truth[k].linear().transpose() * Eigen::Vector3d::UnitZ(), 0.002};
    slam.addKeyframe(input);
  }
  slam.optimizeNow();
  double before = 0, after = 0;
  for (const auto& keyframe : slam.keyframes()) {
    const Eigen::Vector3d up = survey.truth[keyframe.id].linear().row(2);
    before = std::max(before, (survey.odometry[keyframe.id].linear().row(2).transpose() - up).norm());
    after = std::max(after, (keyframe.T_map_vehicle.linear().row(2).transpose() - up).norm());
  }
  EXPECT_LT(after, 0.2 * before);
  EXPECT_LT(after, 0.002);
}

TEST(GraphSlam, Waterline_HoldsTheHeightAndFindsTheSurface) {
  SyntheticSurvey survey = makeLaps(2, 100, 50, 127);
  GraphSlamOptions options = honestOdometry();
  options.waterline.enabled = true;
  options.waterline.height_m = 0.4;
  GraphSlam with(options), without(honestOdometry());
  addAll(with, survey);
  addAll(without, survey);
  with.optimizeNow();
  without.optimizeNow();
  const auto heightError_m = [&](const GraphSlam& slam) {
    double largest = 0;
    for (const auto& keyframe : slam.keyframes())
      largest = std::max(
          largest, std::abs(keyframe.T_map_vehicle.translation().z() - survey.truth[keyframe.id].translation().z()));
    return largest;
  };
  EXPECT_LT(heightError_m(with), 0.5 * heightError_m(without));
  ASSERT_TRUE(with.waterHeight_m());
  // The true vehicle heaves by 5 cm about z = 0, so that the surface lies at -0.4 m; the prior's drift allows the rest.
  EXPECT_NEAR(*with.waterHeight_m(), -0.4, 0.1);
  EXPECT_FALSE(without.waterHeight_m());
}

TEST(GraphSlam, TiltedOdometryFrame_IsLevelledByGravity) {
  // An odometry that started 6 mrad off level, and whose up direction is known better later.
  SyntheticSurvey survey = makeLaps(2, 100, 50, 133);
  survey.stepCovariance = diagonalCovariance(0.003, 0.0001);
  const core::Isometry tilt = core::isometryFromXyzYpr(0, 0, 0, 0, 0.006, 0);
  GraphSlam slam;
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    KeyframeInput input = keyframeInput(survey, k);
    input.T_odom_vehicle = tilt * survey.truth[k];
    const double sigma_rad = k < 100 ? 0.01 : 0.0001, error_rad = k < 100 ? 0.004 : 0.0002;
    input.gravity =
        GravityMeasurement{survey.truth[k].linear().transpose() * Eigen::Vector3d(error_rad, 0, 1), sigma_rad};
    slam.addKeyframe(input);
  }
  slam.optimizeNow();
  double largest = 0;
  for (const auto& keyframe : slam.keyframes())
    largest = std::max(largest, (keyframe.T_map_vehicle.linear() - survey.truth[keyframe.id].linear()).row(2).norm());
  // The late up direction is 0.2 mrad off. The early one is 4 mrad off with a weight of (1 mrad / 9 mrad)^2, against
  // which the odometry over 100 m holds with 2 mrad: 0.2 mrad more. Twice that.
  EXPECT_LT(largest, 0.0008);
}

TEST(GraphSlam, LockThatLiftsTheVessel_DoesNotBendTheHeights) {
  SyntheticSurvey survey = makeLaps(2, 100, 50, 134);
  for (std::size_t k = 300; k < survey.truth.size(); ++k) {
    survey.truth[k].translation().z() += 3;
    survey.odometry[k].translation().z() += 3;
  }
  GraphSlamOptions options = honestOdometry();
  options.waterline.enabled = true;
  GraphSlam slam(options);
  addAll(slam, survey);
  slam.optimizeNow();
  ASSERT_TRUE(slam.waterHeight_m());
  const Keyframe& before = slam.keyframes()[290];
  const Keyframe& after = slam.keyframes()[310];
  // The lift of 3 m stays, within the heave of the truth (5 cm) and the odometry's noise over 20 m.
  EXPECT_NEAR(after.T_map_vehicle.translation().z() - before.T_map_vehicle.translation().z(),
              survey.truth[310].translation().z() - survey.truth[290].translation().z(), 0.15);
}

TEST(GraphSlam, VehicleOnAHill_GivesTheWaterlineUp) {
  SyntheticSurvey survey = makeLaps(1, 100, 50, 135);
  for (std::size_t k = 0; k < survey.truth.size(); ++k) {
    const double hill_m = 8 * std::sin(0.02 * static_cast<double>(k));
    survey.truth[k].translation().z() += hill_m;
    survey.odometry[k].translation().z() += hill_m;
  }
  GraphSlamOptions with = honestOdometry();
  with.waterline.enabled = true;
  GraphSlam slam(with), without(honestOdometry());
  addAll(slam, survey);
  addAll(without, survey);
  slam.optimizeNow();
  without.optimizeNow();
  EXPECT_FALSE(slam.waterHeight_m());
  EXPECT_LT(largestDifference_m(slam, without), 1e-3);  // the solver's tolerance from another start
}

TEST(GraphSlam, MarginalOfAChain_IsItsCompoundedCovariance) {
  const SyntheticSurvey survey = makeLaps(1, 30, 15, 128);
  GraphSlamOptions options = honestOdometry();
  GraphSlam slam(options);
  OdometryChain chain;
  for (std::size_t k = 0; k < survey.odometry.size(); ++k) {
    slam.addKeyframe(keyframeInput(survey, k));
    core::Vector6 floor;
    floor << Eigen::Vector3d::Constant(1e-8), Eigen::Vector3d::Constant(1e-10);
    chain.append(survey.odometry[k], survey.stepCovariance + core::Matrix6(floor.asDiagonal()));
  }
  const auto marginal = slam.marginalCovariance(60);
  ASSERT_TRUE(marginal);
  // The floor is per metre travelled (1 m here, to noise) and the first keyframe is held by 0.1 mm and 0.1 mrad, which
  // at 30 m lever is 3 mm against centimetres.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR((*marginal)(i, i) / chain.covariance(0, 60)(i, i), 1, 0.05) << i;
  EXPECT_FALSE(slam.marginalCovariance(-1));
  EXPECT_FALSE(slam.marginalCovariance(9999));
}

TEST(GraphSlam, WrongInput_IsRefused) {
  const SyntheticSurvey survey = makeLaps(1, 30, 15, 129);
  GraphSlam slam(honestOdometry());
  slam.addKeyframe(keyframeInput(survey, 1));
  EXPECT_THROW(slam.addKeyframe(keyframeInput(survey, 0)), core::InputError);
  KeyframeInput broken = keyframeInput(survey, 2);
  broken.T_odom_vehicle.translation().x() = std::nan("");
  EXPECT_THROW(slam.addKeyframe(broken), core::InputError);
  EXPECT_EQ(slam.keyframes().size(), 1U);
  EXPECT_THROW(slam.offerClosure(0, 0, core::Isometry::Identity(), core::Matrix6::Identity()), core::InputError);
  EXPECT_THROW(slam.offerClosure(0, 4, core::Isometry::Identity(), core::Matrix6::Identity()), core::InputError);
}

TEST(GraphSlam, CovarianceThatIsNone_IsReplacedByTheFloor) {
  SyntheticSurvey survey = makeLaps(1, 30, 15, 130);
  survey.stepCovariance = -core::Matrix6::Identity();
  GraphSlam slam;
  for (std::size_t k = 0; k < 5; ++k) slam.addKeyframe(keyframeInput(survey, k));
  EXPECT_EQ(slam.optimizeNow().status, SolveStatus::converged);
}

TEST(GraphSlam, EmptyGraph_HasNothingToOptimise) {
  GraphSlam slam;
  EXPECT_EQ(slam.optimizeNow().status, SolveStatus::failed);
  EXPECT_TRUE(slam.keyframes().empty());
  EXPECT_EQ(slam.network().nodeCount(), 0U);
}

TEST(GraphSlam, SameInputTwice_GivesTheSameBits) {
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 131);
  std::vector<std::vector<Eigen::Vector3d>> runs;
  for (int run = 0; run < 2; ++run) {
    GraphSlam slam(honestOdometry());
    addAll(slam, survey);
    FixedRandom random(132);
    offerTrueClosures(slam, survey, 10, random);
    slam.optimizeNow();
    runs.push_back(positions(slam));
  }
  EXPECT_EQ(runs[0], runs[1]);
}

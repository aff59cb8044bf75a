#include <gtest/gtest.h>

#include "s2s/graph/consistency.h"
#include "synthetic_survey.h"

using namespace s2s;
using namespace s2s::graph;
using graph::test::diagonalCovariance;
using graph::test::FixedRandom;
using graph::test::makeLaps;
using graph::test::perturbed;
using graph::test::SyntheticSurvey;

namespace {

OdometryChain chainOf(const SyntheticSurvey& survey) {
  OdometryChain chain;
  for (const auto& T : survey.odometry) chain.append(T, survey.stepCovariance);
  return chain;
}

LoopClosure trueClosure(const SyntheticSurvey& survey, int from, int to, FixedRandom& random) {
  LoopClosure closure;
  closure.from = from;
  closure.to = to;
  closure.covariance = diagonalCovariance(0.02, 0.001);
  closure.T_from_to = perturbed(survey.truth[from].inverse() * survey.truth[to], random.normal6(0.02, 0.001));
  return closure;
}

}  // namespace

TEST(Consistency, HonestClosures_HaveChi2OfSixDegreesOfFreedom) {
  FixedRandom random(81);
  double single = 0, pair = 0;
  const int kSurveys = 60;
  for (int s = 0; s < kSurveys; ++s) {
    const SyntheticSurvey survey = makeLaps(2, 60, 30, 800 + s);
    const OdometryChain chain = chainOf(survey);
    const LoopClosure a = trueClosure(survey, 5, 185, random), b = trueClosure(survey, 40, 220, random);
    single += odometryChi2(chain, a) / kSurveys;
    pair += pairChi2(chain, a, b) / kSurveys;
  }
  // The mean of 60 draws of chi2(6), whose variance is 12, lies within 3 sqrt(12 / 60) = 1.34 of 6.
  EXPECT_NEAR(single, 6, 1.34);
  EXPECT_NEAR(pair, 6, 1.34);
}

TEST(Consistency, PairChi2_DoesNotDependOnTheOrder) {
  FixedRandom random(82);
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 83);
  const OdometryChain chain = chainOf(survey);
  const LoopClosure a = trueClosure(survey, 5, 185, random), b = trueClosure(survey, 40, 220, random);
  // First-order covariances at slightly different linearisation points.
  EXPECT_NEAR(pairChi2(chain, a, b), pairChi2(chain, b, a), 0.05 * pairChi2(chain, a, b));
}

TEST(ConsistencySet, FalseClosuresThatAgreeInPairs_AreOutvoted) {
  FixedRandom random(84);
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 85);
  const OdometryChain chain = chainOf(survey);
  ConsistencySet set({});
  std::vector<bool> honest;
  for (int k = 0; k < 20; ++k) {
    LoopClosure closure = trueClosure(survey, 5 * k, 180 + 5 * k, random);
    // A row of equal houses: every third closure is one house (8 m) too far, all in the same way.
    const bool isFalse = k % 3 == 0;
    if (isFalse) closure.T_from_to = perturbed(closure.T_from_to, (core::Vector6() << 8, 0, 0, 0, 0, 0).finished());
    honest.push_back(!isFalse);
    set.add(chain, closure);
  }
  EXPECT_EQ(set.chosen(), honest);
}

TEST(ConsistencySet, LoneClosure_WaitsForSupport) {
  FixedRandom random(86);
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 87);
  const OdometryChain chain = chainOf(survey);
  ConsistencySet set({});
  set.add(chain, trueClosure(survey, 5, 185, random));
  EXPECT_FALSE(set.chosen()[0]);
  set.add(chain, trueClosure(survey, 10, 190, random));
  EXPECT_EQ(set.chosen(), (std::vector<bool>{false, false}));
  EXPECT_EQ(set.waiting(), (std::vector<bool>{true, true}));
  set.add(chain, trueClosure(survey, 15, 195, random));
  EXPECT_EQ(set.chosen(), (std::vector<bool>{true, true, true}));
}

TEST(ConsistencySet, ClosuresFarApart_DoNotSupportEachOther) {
  FixedRandom random(92);
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 93);
  const OdometryChain chain = chainOf(survey);
  ConsistencySet set({});
  for (const int k : {5, 55, 105}) set.add(chain, trueClosure(survey, k, 180 + k, random));
  EXPECT_EQ(set.chosen(), (std::vector<bool>{false, false, false}));
}

TEST(ConsistencySet, BannedClosure_IsNotChosenAgain) {
  FixedRandom random(88);
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 89);
  const OdometryChain chain = chainOf(survey);
  ConsistencySet set({});
  for (const int k : {5, 10, 15, 20}) set.add(chain, trueClosure(survey, k, 180 + k, random));
  set.ban(1);
  set.choose();
  EXPECT_EQ(set.chosen(), (std::vector<bool>{true, false, true, true}));
}

TEST(ConsistencySet, MoreThanSixtyFourClosures_AreAllCompared) {
  FixedRandom random(90);
  const SyntheticSurvey survey = makeLaps(2, 60, 30, 91);
  const OdometryChain chain = chainOf(survey);
  ConsistencySet set({});
  for (int k = 0; k < 150; ++k) set.add(chain, trueClosure(survey, k, 180 + k, random));
  // Each pair passes the 99.9 % gate; the largest clique misses a few closures that fail with one other.
  EXPECT_GE(std::count(set.chosen().begin(), set.chosen().end(), true), 140);
}

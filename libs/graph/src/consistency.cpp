#include "s2s/graph/consistency.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace s2s::graph {

namespace {

core::Vector6 logOf(const core::Isometry& E) {
  core::Vector6 e;
  e << E.translation(), core::logSo3(E.linear());
  return e;
}

double mahalanobis(const core::Isometry& E, core::Matrix6 covariance) {
  covariance.diagonal().array() += 1e-12;
  const core::Vector6 e = logOf(E);
  return e.dot(covariance.ldlt().solve(e));
}

core::Matrix6 transported(const core::Isometry& T_after, const core::Matrix6& covariance) {
  const core::Matrix6 Ad = adjoint(T_after.inverse());
  return Ad * covariance * Ad.transpose();
}

}  // namespace

double odometryChi2(const OdometryChain& chain, const LoopClosure& closure) {
  const core::Isometry X = chain.relative(closure.from, closure.to);
  const core::Isometry E = X.inverse() * closure.T_from_to;
  return mahalanobis(E, transported(E, chain.covariance(closure.from, closure.to)) + closure.covariance);
}

double pairChi2(const OdometryChain& chain, const LoopClosure& a, const LoopClosure& b) {
  // The loop a.T_from_to * X(a.to, b.to) * b.T_from_to^-1 * X(b.from, a.from); each part's perturbation is carried to
  // the loop's end.
  const core::Isometry newer = chain.relative(a.to, b.to);
  const core::Isometry back = b.T_from_to.inverse();
  const core::Isometry older = chain.relative(b.from, a.from);
  const core::Isometry afterNewer = back * older;
  const core::Matrix6 Ad_b = adjoint(b.T_from_to);
  const core::Matrix6 covariance =
      transported(newer * afterNewer, a.covariance) + transported(afterNewer, chain.covariance(a.to, b.to)) +
      transported(older, Ad_b * b.covariance * Ad_b.transpose()) + chain.covariance(b.from, a.from);
  return mahalanobis(a.T_from_to * newer * afterNewer, covariance);
}

namespace {

/// True if both closures join the same two stretches of path.
bool areSideBySide(const OdometryChain& chain, const LoopClosure& a, const LoopClosure& b, double stretch_m) {
  return chain.travelled_m(a.from, b.from) <= stretch_m && chain.travelled_m(a.to, b.to) <= stretch_m;
}

void setBit(std::vector<std::uint64_t>& row, int bit) {
  row[static_cast<std::size_t>(bit) / 64] |= std::uint64_t{1} << (bit % 64);
}

}  // namespace

int ConsistencySet::add(const OdometryChain& chain, const LoopClosure& closure) {
  const int number = static_cast<int>(closures_.size());
  const std::size_t words = static_cast<std::size_t>(number) / 64 + 1;
  for (auto* rows : {&agrees_, &beside_}) {
    for (auto& row : *rows) row.resize(words, 0);
    rows->emplace_back(words, 0);
  }
  for (int other = 0; other < number; ++other) {
    if (banned_[other] || pairChi2(chain, closures_[other], closure) > options_.chi2) continue;
    setBit(agrees_[other], number);
    setBit(agrees_[number], other);
    if (!areSideBySide(chain, closures_[other], closure, options_.stretch_m)) continue;
    setBit(beside_[other], number);
    setBit(beside_[number], other);
  }
  closures_.push_back(closure);
  banned_.push_back(false);
  chosen_.push_back(false);
  waiting_.push_back(false);
  // A larger set than the present one can only contain the new closure.
  take(grow(number, byAgreement()));
  return number;
}

/// Closures that are not banned, those that agree with most others first.
std::vector<int> ConsistencySet::byAgreement() const {
  std::vector<int> agreements(closures_.size(), 0), order;
  for (int c = 0; c < static_cast<int>(closures_.size()); ++c) {
    if (banned_[c]) continue;
    for (const std::uint64_t word : agrees_[c]) agreements[c] += __builtin_popcountll(word);
    order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return agreements[a] > agreements[b]; });
  return order;
}

/// Replaces the chosen set if this one is larger.
void ConsistencySet::take(std::vector<int> clique) {
  if (clique.size() <= best_.size()) return;
  best_ = std::move(clique);
  std::fill(chosen_.begin(), chosen_.end(), false);
  std::fill(waiting_.begin(), waiting_.end(), false);
  Row members(agrees_.empty() ? 0 : agrees_.front().size(), 0);
  for (const int c : best_) setBit(members, c);
  for (const int c : best_) {
    int support = 1;
    for (std::size_t w = 0; w < members.size(); ++w) support += __builtin_popcountll(members[w] & beside_[c][w]);
    (support >= options_.minSupport ? chosen_ : waiting_)[c] = true;
  }
}

std::vector<int> ConsistencySet::grow(int seed, const std::vector<int>& order) const {
  Row candidates = agrees_[seed];
  std::vector<int> clique{seed};
  for (const int c : order) {
    if (!(candidates[static_cast<std::size_t>(c) / 64] >> (c % 64) & 1)) continue;
    clique.push_back(c);
    for (std::size_t w = 0; w < candidates.size(); ++w) candidates[w] &= agrees_[c][w];
  }
  return clique;
}

void ConsistencySet::choose() {
  constexpr std::size_t kStarts = 50;
  const std::vector<int> order = byAgreement();
  best_.clear();
  std::fill(chosen_.begin(), chosen_.end(), false);
  std::fill(waiting_.begin(), waiting_.end(), false);
  for (std::size_t s = 0; s < std::min(order.size(), kStarts); ++s) take(grow(order[s], order));
}

}  // namespace s2s::graph

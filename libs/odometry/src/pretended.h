#pragma once

#include <Eigen/Eigenvalues>

namespace s2s::odometry {

/// What remains of an information when what the noise of the normals only pretends to know is taken off.
template <int N>
struct Known {
  Eigen::Matrix<double, N, N> V;      ///< columns: motions that make both matrices diagonal
  Eigen::Matrix<double, N, 1> known;  ///< information about each of them; 0: none
  Eigen::Matrix<double, N, N> A;      ///< the information left
  Eigen::Matrix<double, N, 1> b;      ///< its right-hand side
};

/// Takes `ratio` times `pretended` off the information `A` with right-hand side `b`, in the coordinates that make both
/// diagonal. `pretended` is what normals with this noise would seem to know where there is nothing to be known.
template <int N>
Known<N> withoutPretended(const Eigen::Matrix<double, N, N>& A, const Eigen::Matrix<double, N, 1>& b,
                          const Eigen::Matrix<double, N, N>& pretended, double ratio) {
  using Matrix = Eigen::Matrix<double, N, N>;
  // A trace of the information itself keeps the noise matrix positive definite.
  const Matrix noise = pretended + 1e-9 * A.diagonal().cwiseMax(1e-9).asDiagonal().toDenseMatrix();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(A, noise);
  Known<N> out;
  out.V = solver.eigenvectors();  // V^T noise V = 1, so V^-1 = V^T noise
  const Matrix inverse = out.V.transpose() * noise;
  Eigen::Matrix<double, N, 1> share;
  for (int i = 0; i < N; ++i) {
    const double mu = solver.eigenvalues()[i];
    out.known[i] = std::max(0.0, mu - ratio);
    share[i] = mu > 0 ? out.known[i] / mu : 0.0;
  }
  out.A = inverse.transpose() * out.known.asDiagonal() * inverse;
  out.b = inverse.transpose() * share.asDiagonal() * out.V.transpose() * b;
  return out;
}

}  // namespace s2s::odometry

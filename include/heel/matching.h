/// \file
/// Nearest neighbours between two feature sets: sign of the Laplacian, ratio test, mutual check.
///
/// - Convention: `ref` is the template (reference view), `cur` the frame; a match holds indices into both
///   sets.
/// - Units: Euclidean distance between unit descriptors, 0…2.
/// - Errors: none.
/// - Source: ratio test: D. Lowe, "Distinctive Image Features from Scale-Invariant Keypoints", IJCV 60(2),
///   2004, section 7.1; sign of the Laplacian: H. Bay et al., "Speeded-Up Robust Features (SURF)", CVIU
///   110(3), 2008.
///
/// The search is exhaustive and exact.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "heel/features.h"

namespace heel {

/// A pair of features whose descriptors are nearest neighbours.
struct Match {
  std::int32_t ref = 0;  ///< index into the template's features
  std::int32_t cur = 0;  ///< index into the frame's features
  float distance = 0.f;  ///< Euclidean, between unit descriptors
};

/// Which nearest neighbours count as a match.
struct MatchSettings {
  float ratio = 0.8f;  ///< nearest / second nearest, Euclidean; smaller is stricter
  bool mutual = true;  ///< each is the other's nearest
};

/// Matches ref to cur; only features of equal Laplacian sign are compared, for the second nearest as well.
/// A ref with a single candidate has no second and passes the ratio test. Matches come in the order of ref.
/// Memory is taken once for the sizes given to the constructor (of larger sets the first features are used);
/// match() does not allocate when `out` has capacity for max_ref matches.
class Matcher {
 public:
  Matcher(int max_ref, int max_cur, const MatchSettings& settings);
  ~Matcher();
  Matcher(Matcher&&) noexcept;
  Matcher& operator=(Matcher&&) noexcept;

  /// Replaces the content of `out`.
  void match(const FeatureSet& ref, const FeatureSet& cur, std::vector<Match>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel

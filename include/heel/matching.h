// Nearest neighbours between two feature sets: Laplacian sign, ratio test, mutual check; exact.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "heel/features.h"

namespace heel {

struct Match {
  std::int32_t ref = 0;  ///< index into the template's features
  std::int32_t cur = 0;  ///< index into the frame's features
  float distance = 0.f;  ///< Euclidean, between unit descriptors
};

struct MatchSettings {
  float ratio = 0.8f;  ///< nearest / second nearest, Euclidean; smaller is stricter
  bool mutual = true;  ///< each is the other's nearest
};

/// Matches ref to cur; only features of equal Laplacian sign are compared, for the second nearest as well.
/// A ref with a single candidate has no second and passes the ratio test. Matches come in the order of ref.
/// Workspace is taken once for the sizes given (larger sets are cut to them); `match` does not allocate when
/// `out` has capacity for max_ref matches.
class Matcher {
 public:
  Matcher(int max_ref, int max_cur, const MatchSettings& settings);
  ~Matcher();
  Matcher(Matcher&&) noexcept;
  Matcher& operator=(Matcher&&) noexcept;

  void match(const FeatureSet& ref, const FeatureSet& cur, std::vector<Match>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel

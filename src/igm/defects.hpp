// Collects violated conditions from parallel loops: all are counted, the ten worst of each kind are
// kept, and the outcome does not depend on the order in which they arrive.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/error.hpp>

namespace hexhex {

class DefectCollector {
 public:
  /// Thread-safe. `amount` in parameter units; larger is worse.
  void add(ErrorCode code, Place place, double amount);

  /// From now on, corners 2 and 3 of tets are swapped with respect to the caller's, in whose terms
  /// faces are to be reported.
  void setCornersReversed(bool reversed) { cornersReversed_ = reversed; }

  /// Forgets what was added.
  void clear() { defects_.clear(); }

  [[nodiscard]] bool empty() const { return defects_.empty(); }
  [[nodiscard]] bool has(ErrorCode code) const { return defects_.contains(code); }

  /// Where this defect occurs, others follow from it: report it first.
  void setRootCause(ErrorCode code) { rootCause_ = code; }

  /// All defects: the root cause, then the others in the order of the codes.
  [[nodiscard]] std::vector<Defect> defects() const;

  /// Throws the first of defects(), if any, as an Error whose sentence names its worst place.
  void throwIfAny() const;

 private:
  std::mutex mutex_;
  std::map<ErrorCode, Defect> defects_;
  bool cornersReversed_ = false;
  ErrorCode rootCause_ = ErrorCode::Internal;
};

}  // namespace hexhex

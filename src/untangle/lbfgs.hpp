// Limited-memory BFGS (Nocedal 1980) with a given first metric.
#pragma once

#include <deque>

#include <untangle/energy.hpp>
#include <untangle/multigrid.hpp>

namespace hexhex::untangle {

class Lbfgs {
 public:
  /// @param energy, metric  must outlive this
  /// @param x  where it begins
  /// @param epsilon  of the energy
  Lbfgs(Energy& energy, const Multigrid& metric, const Vector& x, double epsilon);

  /// One step downhill.
  /// @param[in,out] x  where the last step ended
  /// @return false if there is none
  bool step(Vector& x);

  /// At x as it is.
  [[nodiscard]] const Height& height() const noexcept { return height_; }

 private:
  struct Pair {
    Vector move;
    Vector change;  ///< of the gradient
    double product = 0;
  };
  [[nodiscard]] Vector direction() const;
  bool search(const Vector& towards, Vector& x);
  void learn(Pair pair);

  Energy& energy_;
  const Multigrid& metric_;
  double epsilon_;
  Height height_;
  Vector gradient_;
  double scale_ = 1;        ///< of the metric
  std::deque<Pair> pairs_;  ///< the latest ones
};

}  // namespace hexhex::untangle

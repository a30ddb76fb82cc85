// What the opaque handles are.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/repair.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include "guard.hpp"

struct hexhex_context {
  hexhex_context(int threads, hexhex_progress progress, void* user);
  hexhex::Context context;
  std::atomic<bool> busy{false};
};

struct hexhex_map {
  std::shared_ptr<const hexhex::TetMap> owned;  ///< null if the arrays are the caller's
  hexhex::TetMapView view;
};

struct hexhex_mesh {
  hexhex::HexMesh own;
  const hexhex::HexMesh* lent = nullptr;  ///< this one instead, which belongs to another handle
  [[nodiscard]] const hexhex::HexMesh& mesh() const noexcept { return lent ? *lent : own; }

  // Of the extraction that made it:
  hexhex::RepairReport repair = {};
  std::shared_ptr<const hexhex::TetMap> repairedMap = nullptr;
};

struct hexhex_buffer {
  std::variant<hexhex::Array<hexhex::Vec3>, hexhex::Array<hexhex::Hex>,
               hexhex::Array<hexhex::Index>, hexhex::Array<hexhex::CornerSet>,
               hexhex::Array<std::int32_t>, std::vector<hexhex::FeatureVertex>,
               std::vector<hexhex::FeatureEdge>, std::vector<hexhex::FeatureQuad>,
               std::vector<hexhex_singular_edge>>
      array;
};

struct hexhex_extractor {
  hexhex::Extractor extractor;
  std::atomic<bool> busy{false};
};

struct hexhex_check_report {
  hexhex::CheckReport report;
};

struct hexhex_verify_report {
  hexhex::VerifyReport report;
};

struct hexhex_repair_report {
  hexhex::RepairReport report;
};

struct hexhex_holes {
  std::vector<hexhex::Hole> holes;
  std::uint64_t invalidTets = 0;
  double missingCells = 0;
  std::uint64_t faceConflicts = 0;
};

struct hexhex_piecewise_mesh {
  hexhex::PiecewiseLinearMesh piecewise;
  hexhex_mesh straight;  ///< the mesh in it, for the caller to see
};

struct hexhex_lagrange_mesh {
  hexhex::LagrangeMesh mesh;
};

struct hexhex_mesh_writer {
  hexhex::Context own;
  std::unique_ptr<hexhex::MeshSink> sink;
};

namespace hexhex::c {

/// Occupies a handle that serves one call at a time.
class Occupied {
 public:
  Occupied(std::atomic<bool>& busy, const char* argument) : busy_(busy) {
    if (busy.exchange(true)) throwBusy(argument);
  }
  ~Occupied() { busy_.store(false); }
  Occupied(const Occupied&) = delete;
  Occupied& operator=(const Occupied&) = delete;

 private:
  std::atomic<bool>& busy_;
};

/// The caller's context, or one with defaults.
class ContextOrDefault {
 public:
  explicit ContextOrDefault(hexhex_context* given) : given_(given) {
    if (given_ != nullptr && given_->busy.exchange(true)) throwBusy("context");
  }
  ~ContextOrDefault() {
    if (given_ != nullptr) given_->busy.store(false);
  }
  ContextOrDefault(const ContextOrDefault&) = delete;
  ContextOrDefault& operator=(const ContextOrDefault&) = delete;
  Context& operator*() noexcept { return given_ != nullptr ? given_->context : own_; }

 private:
  hexhex_context* given_;
  Context own_;
};

/// A pointer to the scalars of an array; NULL if it is empty.
template <class Scalar, class List>
const Scalar* flat(const List& array) {
  return array.empty() ? nullptr : reinterpret_cast<const Scalar*>(array.data());
}

/// `count` elements of T in the caller's flat array.
template <class T, class Scalar>
std::span<const T> borrowed(const Scalar* data, std::size_t count, const char* argument) {
  if (count != 0 && data == nullptr) throwNull(argument);
  return {reinterpret_cast<const T*>(data), count};
}

/// Element i of a report's list.
template <class List>
const auto& at(const List& list, std::size_t i, const char* what) {
  if (i >= list.size()) {
    throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(list.size()) + " " +
                                                what + "; there is no number " + std::to_string(i) +
                                                ".");
  }
  return list[i];
}

/// Makes a handle of a map.
void give(std::shared_ptr<const TetMap> map, hexhex_map** out);
void give(TetMap&& map, hexhex_map** out);
void give(HexMesh&& mesh, hexhex_mesh** out);
[[nodiscard]] TetMap copyOf(const hexhex_map& map);

void writeQuality(const QualitySummary& summary, hexhex_quality& out);

}  // namespace hexhex::c

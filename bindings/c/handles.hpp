// What the opaque handles are.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include "guard.hpp"

struct hexhex_context {
  hexhex_context(int threads, hexhex_progress progress, void* user);
  hexhex::Context context;
};

struct hexhex_map {
  hexhex::TetMap owned;  ///< empty if the arrays are the caller's
  hexhex::TetMapView view;
};

struct hexhex_mesh {
  hexhex::HexMesh mesh;
};

struct hexhex_buffer {
  std::variant<hexhex::Array<hexhex::Vec3>, hexhex::Array<hexhex::Hex>,
               hexhex::Array<hexhex::Index>, hexhex::Array<hexhex::CornerSet>>
      array;
};

struct hexhex_extractor {
  hexhex::Extractor extractor;
};

struct hexhex_check_report {
  hexhex::CheckReport report;
};

struct hexhex_verify_report {
  hexhex::VerifyReport report;
};

namespace hexhex::c {

/// The caller's context, or one with defaults.
class ContextOrDefault {
 public:
  explicit ContextOrDefault(hexhex_context* given) : given_(given) {}
  Context& operator*() noexcept { return given_ != nullptr ? given_->context : own_; }

 private:
  hexhex_context* given_;
  Context own_;
};

}  // namespace hexhex::c

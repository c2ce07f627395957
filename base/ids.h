#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace atlaswire {

/// Server frame of one stream, counted from 0; compare with serial arithmetic, it may wrap.
enum class FrameId : std::uint32_t {};
/// Client pose, counted from 1 by each client; 0 means "none yet".
enum class PoseId : std::uint32_t {};
/// Patch of a scene: index into Scene::patches, dense from 0.
enum class PatchId : std::uint32_t {};
/// Position vertex of a scene (welded): index into Scene::positions, dense from 0.
enum class VertexId : std::uint32_t {};
/// Session of one daemon run, counted from 1.
enum class SessionId : std::uint32_t {};

/// The number behind an id, for indexing and for the wire.
template <class Id>
constexpr std::uint32_t value(Id id) {
  return static_cast<std::uint32_t>(id);
}

/// RFC 1982 serial order for wrapping 32-bit ids: does `a` come after `b`? Defined within 2^31.
template <class Id>
constexpr bool is_newer(Id a, Id b) {
  return static_cast<std::int32_t>(value(a) - value(b)) > 0;
}

/// The id after `id`, wrapping.
template <class Id>
constexpr Id next(Id id) {
  return static_cast<Id>(value(id) + 1U);
}

}  // namespace atlaswire

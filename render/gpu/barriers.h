#pragma once

#include "render/gpu/vk.h"

namespace atlaswire::render {

/// Memory barriers on buffers by what they order. Each waits for every earlier write of its source kind.

/// Uploads (copies, fills) before any shader, vertex fetch or indirect read.
void transfer_to_shaders(const vk::raii::CommandBuffer& commands);
/// Compute writes before later compute reads and writes.
void compute_to_compute(const vk::raii::CommandBuffer& commands);
/// Compute writes before vertex fetch, indirect draws and shader reads of graphics.
void compute_to_draw(const vk::raii::CommandBuffer& commands);
/// Stores of fragment shaders before compute reads.
void fragment_to_compute(const vk::raii::CommandBuffer& commands);
/// Compute or transfer writes before a copy.
void shaders_to_transfer(const vk::raii::CommandBuffer& commands);
/// Everything written before the host's reads, once the submission is waited for.
void writes_to_host(const vk::raii::CommandBuffer& commands);

}  // namespace atlaswire::render

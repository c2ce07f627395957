#include "render/gpu/barriers.h"

namespace atlaswire::render {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

void barrier(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlags2 from, vk::AccessFlags2 wrote,
             vk::PipelineStageFlags2 to, vk::AccessFlags2 uses) {
  const vk::MemoryBarrier2 memory{
      .srcStageMask = from, .srcAccessMask = wrote, .dstStageMask = to, .dstAccessMask = uses};
  commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &memory});
}

const vk::PipelineStageFlags2 kDrawStages =
    Stage::eDrawIndirect | Stage::eVertexInput | Stage::eVertexShader | Stage::eFragmentShader;
const vk::AccessFlags2 kDrawReads = Access::eIndirectCommandRead | Access::eVertexAttributeRead |
                                    Access::eIndexRead | Access::eUniformRead | Access::eShaderStorageRead |
                                    Access::eShaderStorageWrite;

}  // namespace

void transfer_to_shaders(const vk::raii::CommandBuffer& commands) {
  barrier(commands, Stage::eTransfer, Access::eTransferWrite, kDrawStages | Stage::eComputeShader,
          kDrawReads);
}

void compute_to_compute(const vk::raii::CommandBuffer& commands) {
  barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eComputeShader,
          Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eUniformRead);
}

void compute_to_draw(const vk::raii::CommandBuffer& commands) {
  barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, kDrawStages, kDrawReads);
}

void fragment_to_compute(const vk::raii::CommandBuffer& commands) {
  barrier(commands, Stage::eFragmentShader, Access::eShaderStorageWrite, Stage::eComputeShader,
          Access::eShaderStorageRead | Access::eShaderStorageWrite);
}

void shaders_to_transfer(const vk::raii::CommandBuffer& commands) {
  barrier(commands, Stage::eComputeShader | Stage::eFragmentShader | Stage::eTransfer,
          Access::eShaderStorageWrite | Access::eTransferWrite, Stage::eTransfer,
          Access::eTransferRead | Access::eTransferWrite);
}

void writes_to_host(const vk::raii::CommandBuffer& commands) {
  barrier(commands, Stage::eAllCommands, Access::eMemoryWrite, Stage::eHost, Access::eHostRead);
}

}  // namespace atlaswire::render

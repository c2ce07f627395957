#pragma once

/// The one door to Vulkan: vulkan.hpp with RAII handles, aggregates for designated initializers, and its
/// functions loaded at run time, so that programs start (and can say so) without a Vulkan loader.
/// Slow to compile: include it only in sources and in render/ headers that hold handles; targets that do
/// precompile it (see aw_use_vulkan in render/CMakeLists.txt).
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#define VULKAN_HPP_NO_SPACESHIP_OPERATOR
#include <vulkan/vulkan_raii.hpp>

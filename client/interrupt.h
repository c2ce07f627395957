#pragma once

namespace atlaswire::client {

/// From now on the first SIGINT or SIGTERM only sets a flag, and the second one kills as usual.
void watch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace atlaswire::client

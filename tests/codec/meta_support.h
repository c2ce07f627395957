#pragma once

#include "base/random.h"
#include "codec/meta_update.h"

namespace atlaswire::codec {

/// The limits that the tests' updates obey.
MetaLimits test_limits();

/// A valid update of about `size` entries a list: ascending ids, moved patches neither added nor removed.
MetaUpdate random_update(Random& random, std::size_t size);

/// Equal in every field a receiver can see.
bool same(const MetaUpdate& a, const MetaUpdate& b);

}  // namespace atlaswire::codec

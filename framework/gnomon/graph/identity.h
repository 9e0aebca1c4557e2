// What makes two passes the same. Not part of the contract.
#pragma once

#include <string>

#include "gnomon/graph/state.h"

namespace gnomon {

/// Equal for passes that write the same bits whatever happens, in graphs of one
/// session; empty for one that is never shared (see Graph). Earlier passes must
/// know already whether they are shared.
std::string identityOf(const Graph::State& state, const PassNode& node);

}  // namespace gnomon

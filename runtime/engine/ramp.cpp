// SPDX-License-Identifier: MIT
#include "hairloom/ramp.h"

#include <sstream>

namespace hairloom::runtime {
namespace {

bool isPlaced(std::span<const Ramp::Key> keys, std::size_t k) {
    if (k == 0) return keys[k].at == 0.0f;
    if (k + 1 == keys.size()) return keys[k].at == 1.0f && keys[k - 1].at < 1.0f;
    return keys[k].at > keys[k - 1].at && keys[k].at < 1.0f;
}

template <class... Parts>
std::string joined(const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    return text.str();
}

}  // namespace

std::string validationError(const Ramp& ramp) {
    if (ramp.count < 2 || ramp.count > Ramp::kMaxKeys)
        return joined("has ", ramp.count, " keys; expected 2 to ", Ramp::kMaxKeys);
    const auto keys = ramp.inUse();
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const auto [at, value] = keys[k];
        if (!isPlaced(keys, k))
            return joined("has key ", k, " at ", at,
                          "; expected the first at 0, the last at 1, each behind the one before");
        if (!(value >= 0.0f && value <= 1.0f))
            return joined("has the value ", value, " at key ", k, "; expected 0 to 1");
    }
    return {};
}

}  // namespace hairloom::runtime

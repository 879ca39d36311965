// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/stop_scope.h"

namespace hairloom {
namespace {

thread_local const std::atomic<bool>* flag = nullptr;

}  // namespace

StopScope::StopScope(const std::atomic<bool>& stop) : outer_(flag) {
    flag = &stop;
}

StopScope::~StopScope() {
    flag = outer_;
}

Status checkStop() {
    if (flag && *flag) return fail("stopped before it was done");
    return {};
}

}  // namespace hairloom

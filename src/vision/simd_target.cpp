#include "vision/simd_target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/simd_target.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

const char* OwnName() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(OwnName);

const char* simd_target_name() {
  return HWY_DYNAMIC_DISPATCH(OwnName)();
}

}  // namespace heel
#endif  // HWY_ONCE

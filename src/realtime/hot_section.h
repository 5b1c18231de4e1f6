// Marks the parts of a thread's work in which it must not allocate, lock or format text. A test's library
// that is loaded beforehand (tests/support/hot_trap.cpp) is called at each and stops the program at the first
// call that breaks the rule. Without it, a mark costs nothing.
//
//   void VisionLoop::run() {
//     const HotSection hot;
//     while (...) ...
#pragma once

namespace heel {

class HotSection {
 public:
  HotSection();
  ~HotSection();
  HotSection(const HotSection&) = delete;
  HotSection& operator=(const HotSection&) = delete;
};

}  // namespace heel

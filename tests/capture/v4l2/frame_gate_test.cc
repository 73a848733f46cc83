#include "capture/camera/v4l2/frame_gate.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace eyebox::capture {
namespace {

TEST(FrameGate, PassesOverFramesThatNobodyAskedFor) {
  FrameGate gate(0);
  EXPECT_FALSE(gate.Admit(0, 100));
  EXPECT_FALSE(gate.Admit(1, 200));
  gate.Trigger(250);
  const auto frame = gate.Admit(2, 300);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->frame_id, 1);
  EXPECT_EQ(frame->trigger_time_ns, 250);
  EXPECT_FALSE(gate.Admit(3, 400));
}

TEST(FrameGate, PassesOverAFrameThatHadBegunBeforeTheTrigger) {
  FrameGate gate(0);
  gate.Trigger(250);
  EXPECT_FALSE(gate.Admit(0, 249));
  EXPECT_TRUE(gate.Admit(1, 250));
}

TEST(FrameGate, PassesOverFramesFromBeforeTheSettingsTookHold) {
  FrameGate gate(1000);
  gate.Trigger(10);
  EXPECT_FALSE(gate.Admit(0, 999));
  EXPECT_TRUE(gate.Admit(1, 1000));
}

TEST(FrameGate, AnswersTriggersInOrderOneFrameEach) {
  FrameGate gate(0);
  gate.Trigger(10);
  gate.Trigger(20);
  EXPECT_EQ(gate.Admit(0, 100)->trigger_time_ns, 10);
  const auto second = gate.Admit(1, 200);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->trigger_time_ns, 20);
  EXPECT_EQ(second->frame_id, 2);
  EXPECT_FALSE(gate.Admit(2, 300));
}

TEST(FrameGate, CountsALostFrameThatWouldHaveAnswered) {
  FrameGate gate(0);
  gate.Trigger(10);
  gate.Trigger(20);
  EXPECT_EQ(gate.Admit(0, 100)->frame_id, 1);
  EXPECT_EQ(gate.Admit(3, 400)->frame_id, 4);  // 200 and 300 were wanted
}

TEST(FrameGate, DoesNotCountALostFrameFromBeforeTheTrigger) {
  FrameGate gate(0);
  EXPECT_FALSE(gate.Admit(0, 100));
  gate.Trigger(450);
  // 200, 300 and 400 were lost before the trigger, 500 after it.
  EXPECT_EQ(gate.Admit(5, 600)->frame_id, 2);
}

TEST(FrameGate, FollowsTheSequenceAcrossItsWrap) {
  FrameGate gate(0);
  gate.Trigger(10);
  gate.Trigger(20);
  EXPECT_EQ(gate.Admit(UINT32_MAX, 100)->frame_id, 1);
  EXPECT_EQ(gate.Admit(1, 300)->frame_id, 3);  // sequence 0 was lost
}

TEST(FrameGate, LetsARepeatedSequenceNumberNotPassForTheNextFrame) {
  FrameGate gate(0);
  gate.Trigger(10);
  gate.Trigger(20);
  EXPECT_EQ(gate.Admit(7, 100)->frame_id, 1);
  EXPECT_EQ(gate.Admit(7, 200)->frame_id, 1);
}

TEST(FrameGate, GivesUpTheOldestTriggerAlone) {
  FrameGate gate(0);
  gate.Trigger(10);
  gate.Trigger(20);
  gate.Abandon();
  EXPECT_EQ(gate.Admit(0, 100)->trigger_time_ns, 20);
  gate.Abandon();  // none is left, nothing happens
  EXPECT_FALSE(gate.Admit(1, 200));
}

}  // namespace
}  // namespace eyebox::capture

// `eyebox capture` and `eyebox devices` as they are typed.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "eyebox/v1/capture.pb.h"
#include "eyebox/v1/results.pb.h"
#include "service/devices.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// One dark, three levels, a reference before and after.
constexpr char kSmall[] = " --levels 3 --exposures 0.0125 --flat-repeats 0 --dark-repeats 2";

double Value(const v1::CaptureResult& result, const std::string& name) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == name) return parameter.value();
  }
  ADD_FAILURE() << "no parameter " << name;
  return -1;
}

class CliCapture : public testing::Test {
 protected:
  std::string Command(const std::string& options, const std::string& rig = "sim:rift-s-like") {
    return "capture " + rig + " --out " + recording_ + options;
  }
  // Answers of someone who presses Enter so often.
  std::string Answers(size_t times) {
    EXPECT_TRUE(WriteFileAtomically(folder_ / "answers", std::string(times, '\n')).ok());
    return " <" + (folder_ / "answers").string();
  }

  const TemporaryFolder folder_;
  const std::string recording_ = folder_ / "recording";
};

TEST_F(CliCapture, RecordsASimulatedRigByItself) {
  const auto result =
      ParsedFrom<v1::CaptureResult>(RunEyebox(Command(std::string(kSmall) + " --json")));
  EXPECT_EQ(Value(result, "captures"), 6);
  EXPECT_EQ(Value(result, "frames"), 2 + 3 * 2 + 2 * 4);
  EXPECT_EQ(Value(result, "captures_taken_again"), 0);
  EXPECT_EQ(result.recording(), recording_);
  EXPECT_TRUE(std::filesystem::exists(result.log()));
  EXPECT_THAT(result.warnings(), IsEmpty());
  EXPECT_EQ(RunEyebox("verify-files " + recording_).exit_code, 0);
  const Outcome again = RunEyebox(Command(kSmall));
  EXPECT_EQ(again.exit_code, 3) << "a recording is never overwritten";
}

TEST_F(CliCapture, AsksForEveryPatchAndGoesOnWhereItStopped) {
  const Outcome stopped = RunEyebox(Command(std::string(kSmall) + " --manual") + Answers(3));
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("cover the lens"), HasSubstr("full field of drive 0.5"),
                                 HasSubstr("standard input ended"), HasSubstr("--resume")));
  const auto result =
      ParsedFrom<v1::CaptureResult>(RunEyebox(Command(" --resume --manual --json") + Answers(100)));
  const double taken = Value(result, "captures");
  EXPECT_GT(taken, 0);
  EXPECT_LT(taken, 6);
  EXPECT_EQ(RunEyebox("verify-files " + recording_).exit_code, 0);
  const auto nothing = ParsedFrom<v1::CaptureResult>(RunEyebox(Command(" --resume --json")));
  EXPECT_EQ(Value(nothing, "captures"), 0);
}

TEST_F(CliCapture, ResumesNeitherAnotherPlanNorAnotherRig) {
  ASSERT_EQ(RunEyebox(Command(kSmall)).exit_code, 0);
  const Outcome plan = RunEyebox(Command(" --resume --levels 5"));
  EXPECT_EQ(plan.exit_code, 3);
  EXPECT_THAT(plan.err, AllOf(HasSubstr(recording_), HasSubstr("another plan")));
  const Outcome rig = RunEyebox(Command(" --resume", "sim:ideal"));
  EXPECT_EQ(rig.exit_code, 3);
  EXPECT_THAT(rig.err, HasSubstr("begun with sim:rift-s-like"));
  EXPECT_EQ(RunEyebox(Command(std::string(kSmall) + " --resume")).exit_code, 0) << "the same plan";
}

TEST_F(CliCapture, ExitCodesAreThoseOfTheDesign) {
  EXPECT_EQ(RunEyebox("capture sim:rift-s-like").exit_code, 2) << "no --out";
  EXPECT_EQ(RunEyebox(Command(" --levels 1")).exit_code, 2);
  EXPECT_EQ(RunEyebox(Command(" --exposures 0.1,0.1")).exit_code, 3);
  EXPECT_EQ(RunEyebox(Command(" --settle-least 9 --settle-longest 3")).exit_code, 3);
  EXPECT_EQ(RunEyebox(Command("", "sim:unheard-of")).exit_code, 3);
  EXPECT_EQ(RunEyebox(Command(" --resume")).exit_code, 3);
  EXPECT_EQ(RunEyebox(Command("", "v4l2:/dev/null")).exit_code, 3) << "is no camera";
  EXPECT_FALSE(std::filesystem::exists(recording_));
}

TEST_F(CliCapture, ACameraThatFailsIsExitCode4AndTheWayOnIsTold) {
  ASSERT_EQ(RunEyebox(Command(kSmall)).exit_code, 0);
  const std::string rig = folder_ / "rig.textproto";
  ASSERT_TRUE(
      WriteFileAtomically(rig, "name: \"again\" camera_uri: \"replay:" + recording_ + "\" seed: 1")
          .ok());
  // The replay has 2 frames of a level, not 3.
  const Outcome outcome = RunEyebox("capture " + rig + " --out " + (folder_ / "again").string() +
                                    kSmall + " --repeats 3");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("again --resume"));
  EXPECT_EQ(RunEyebox("verify-files " + (folder_ / "again").string()).exit_code, 0)
      << "what was published stays sound";
}

// The binary with its stdin on a pipe to which nothing is written.
class WaitingEyebox {
 public:
  WaitingEyebox(const std::string& recording, const std::string& err) : err_(err) {
    EXPECT_EQ(::pipe(pipe_), 0);
    child_ = ::fork();
    if (child_ != 0) return;
    ::dup2(pipe_[0], STDIN_FILENO);
    ::dup2(::open(err.c_str(), O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
    ::execl(EYEBOX_BINARY_DIR "/bin/eyebox", "eyebox", "capture", "sim:rift-s-like", "--levels",
            "3", "--manual", "--out", recording.c_str(), nullptr);
    ::_exit(127);
  }
  ~WaitingEyebox() {
    ::close(pipe_[0]);
    ::close(pipe_[1]);
  }
  // Until it asks for something.
  bool Asks() const {
    for (int i = 0; i < 6000; ++i) {
      if (ReadWholeFile(err_).value_or("").find("then Enter") != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  int Interrupt() const {
    ::kill(child_, SIGINT);
    int status = 0;
    ::waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  const std::string err_;
  int pipe_[2] = {-1, -1};
  pid_t child_ = -1;
};

TEST_F(CliCapture, CtrlCStopsItWhileItAsksAndItCanBeResumed) {
  const std::string err = folder_ / "err";
  const WaitingEyebox eyebox(recording_, err);
  ASSERT_TRUE(eyebox.Asks()) << *ReadWholeFile(err);
  EXPECT_EQ(eyebox.Interrupt(), 3);
  EXPECT_THAT(*ReadWholeFile(err), HasSubstr("--resume"));
  EXPECT_EQ(RunEyebox(Command(" --resume")).exit_code, 0);
  EXPECT_EQ(RunEyebox("verify-files " + recording_).exit_code, 0);
}

bool Lists(const google::protobuf::RepeatedPtrField<v1::Device>& devices, const std::string& uri) {
  for (const v1::Device& device : devices) {
    if (device.uri() == uri) return true;
  }
  return false;
}

TEST(CliDevices, ListsWhatIsAlwaysThere) {
  const auto devices = ParsedFrom<v1::DevicesResult>(RunEyebox("devices --json"));
  EXPECT_TRUE(Lists(devices.cameras(), "sim:rift-s-like"));
  EXPECT_TRUE(Lists(devices.cameras(), "aravis:fake"));
  EXPECT_FALSE(devices.photodiodes().empty());
  const Outcome text = RunEyebox("devices");
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, AllOf(HasSubstr("cameras"), HasSubstr("photodiodes"), HasSubstr("triggers"),
                              HasSubstr("sim:rift-s-like")));
}

TEST(Devices, OfAMachineAreFoundByTheirNodes) {
  const TemporaryFolder folder;
  const auto touch = [&folder](const std::string& file, const std::string& content = "") {
    ASSERT_TRUE(WriteFileAtomically(folder.path() / file, content).ok());
  };
  for (const char* node : {"ttyACM0", "ttyUSB3", "ttyS0", "gpiochip10", "gpiochip2", "video0"}) {
    touch("dev/" + std::string(node));
  }
  touch("iio/iio:device0/name", "ads1015\n");
  touch("iio/iio:device0/in_voltage0_raw", "12\n");
  touch("iio/iio:device0/in_voltage0_scale", "3\n");
  const v1::DevicesResult devices =
      ListDevices({.nodes = folder / "dev", .iio = folder / "iio", .ask_network = false});
  EXPECT_EQ(devices.photodiodes(0).uri(), "iio:ads1015/voltage0");
  EXPECT_THAT(devices.photodiodes(0).problem(), HasSubstr("No such file")) << "no node in dev";
  EXPECT_TRUE(Lists(devices.photodiodes(), "serial:" + (folder / "dev").string() + "/ttyACM0"));
  EXPECT_TRUE(Lists(devices.photodiodes(), "serial:" + (folder / "dev").string() + "/ttyUSB3"));
  EXPECT_FALSE(Lists(devices.photodiodes(), "serial:" + (folder / "dev").string() + "/ttyS0"));
  EXPECT_FALSE(Lists(devices.photodiodes(), "iio:ads1015/voltage0_scale"));
  ASSERT_EQ(devices.triggers().size(), 2);
  EXPECT_EQ(devices.triggers(0).uri(), "gpiochip2:LINE");
  EXPECT_EQ(devices.triggers(1).uri(), "gpiochip10:LINE");
  const v1::Device& video = devices.cameras(devices.cameras_size() - 1);
  EXPECT_EQ(video.uri(), "v4l2:" + (folder / "dev").string() + "/video0");
  EXPECT_THAT(video.problem(), Not(IsEmpty())) << "a plain file is no camera";
}

TEST(Devices, OfAMachineWithoutAnyAreTheSimulatedOnes) {
  const TemporaryFolder folder;
  const v1::DevicesResult devices =
      ListDevices({.nodes = folder / "no", .iio = folder / "no", .ask_network = false});
  EXPECT_TRUE(Lists(devices.cameras(), "sim:ideal"));
  EXPECT_THAT(devices.triggers(), IsEmpty());
}

}  // namespace
}  // namespace eyebox::service

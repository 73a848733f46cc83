// What the catalogue says of recordings, and that it follows the files.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "service/server/catalogue/describe.h"
#include "tests/service/server/catalogue_fixture.h"

namespace eyebox::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class CatalogueTest : public CatalogueFixture {};

TEST_F(CatalogueTest, SaysWhatTheFilesSay) {
  WriteSmall(Data() / "lab/whole", {});
  WriteSmall(Data() / "cut", {.taken = 1});
  std::filesystem::create_directories(Data() / "cut/results/second");
  std::filesystem::create_directories(Data() / "cut/results/first");
  const v1::RecordingEntry whole = Entry("lab/whole");
  EXPECT_EQ(whole.state(), v1::RECORDING_STATE_COMPLETE);
  EXPECT_EQ(whole.captures(), 2);
  EXPECT_EQ(whole.frames(), 6);
  EXPECT_EQ(whole.levels(), 2);
  EXPECT_EQ(whole.header().rig().name(), "lab");
  EXPECT_EQ(whole.header().plan().captures_size(), 0) << "a page of plans would be large";
  EXPECT_THAT(whole.series(), ElementsAre("", "blue"));
  EXPECT_THAT(whole.results(), IsEmpty());
  EXPECT_EQ(static_cast<uint64_t>(whole.bytes()),
            std::filesystem::file_size(Data() / "lab/whole/captures/000001.h5") +
                std::filesystem::file_size(Data() / "lab/whole/captures/000002.h5"));
  const v1::RecordingEntry cut = Entry("cut");
  EXPECT_EQ(cut.state(), v1::RECORDING_STATE_PARTIAL);
  EXPECT_EQ(cut.captures(), 1);
  EXPECT_THAT(cut.results(), ElementsAre("first", "second"));
  EXPECT_THAT(told_, ElementsAre(HasSubstr("does not exist")));
}

TEST_F(CatalogueTest, FollowsWhatOthersDoToTheFolder) {
  EXPECT_THAT(Names(), IsEmpty());
  std::unique_ptr<capture::RecordingWriter> writer;
  const SmallRecording what = {.taken = 0};
  WriteSmall(Data() / "a", what, &writer);
  EXPECT_EQ(Entry("a").captures(), 0);
  TakeSmall(what, 0, *writer);
  EXPECT_EQ(Entry("a").captures(), 1);
  {
    auto under_way = writer->BeginCapture(SmallSpec(what, 1), kSmallSize);
    ASSERT_TRUE(under_way.ok());
    EXPECT_EQ(Entry("a").state(), v1::RECORDING_STATE_PARTIAL);
  }
  TakeSmall(what, 1, *writer);
  EXPECT_EQ(Entry("a").state(), v1::RECORDING_STATE_COMPLETE);
  ASSERT_TRUE(writer->SuspectSince(2, "the headset slept").ok());
  EXPECT_EQ(Entry("a").state(), v1::RECORDING_STATE_PARTIAL);
  std::filesystem::rename(Data() / "a", Data() / "b");
  EXPECT_THAT(Names(), ElementsAre("b"));
  std::filesystem::create_directories(Data() / "b/results/table");
  EXPECT_THAT(Names("results:table"), ElementsAre("b"));
  std::filesystem::remove_all(Data() / "b");
  EXPECT_THAT(Names(), IsEmpty());
  EXPECT_EQ(told_.size(), 1u) << "none of this makes the file anew";
}

TEST_F(CatalogueTest, DamagedRecordingIsListedWithTheReasonAndWithoutFigures) {
  for (const char* name : {"header", "log", "capture", "gone", "short", "link"}) {
    WriteSmall(Data() / name, {});
  }
  EXPECT_EQ(Names("state = COMPLETE").size(), 6u);
  FlipByte(Data() / "header/recording.textproto", 3);
  FlipByte(Data() / "log/manifest.log", 20);
  FlipByte(Data() / "capture/captures/000001.h5", 3);
  std::filesystem::remove(Data() / "gone/captures/000002.h5");
  std::filesystem::resize_file(Data() / "short/captures/000002.h5", 100);
  std::filesystem::create_symlink("/etc/passwd", Data() / "link/captures/passwd");
  EXPECT_THAT(Names("state = COMPLETE"), IsEmpty());
  EXPECT_EQ(Names("state = DAMAGED AND frames = 0").size(), 6u);
  EXPECT_THAT(Entry("gone").problem(), HasSubstr("recordings/gone/captures/000002.h5"));
  EXPECT_THAT(Entry("log").problem(), HasSubstr("manifest.log"));
  std::filesystem::remove(Data() / "link/captures/passwd");
  EXPECT_THAT(Names("state = COMPLETE"), ElementsAre("link"));
}

TEST_F(CatalogueTest, OnlyWhatWasTouchedIsReadAgain) {
  WriteSmall(Data() / "a", {});
  EXPECT_EQ(Names().size(), 1u);
  // Reading is seen by what a change that leaves no trace does: nothing.
  const auto file = Data() / "a/manifest.log";
  const std::string stamp = StampOf(*data_, "recordings/a", kFarFutureNs);
  EXPECT_EQ(stamp, StampOf(*data_, "recordings/a", kFarFutureNs));
  FlipByte(file, 20);
  EXPECT_NE(stamp, StampOf(*data_, "recordings/a", kFarFutureNs));
  EXPECT_EQ(Entry("a").state(), v1::RECORDING_STATE_DAMAGED);
  // What was touched at this very moment may be touched again without another stamp.
  EXPECT_EQ(StampOf(*data_, "recordings/a", 0), "");
  EXPECT_EQ(StampOf(*data_, "recordings/none", kFarFutureNs), "");
}

TEST_F(CatalogueTest, FiltersAndOrders) {
  WriteSmall(Data() / "c", {.rig = "left-eye", .start_ns = 3'000'000'000});
  WriteSmall(Data() / "a", {.rig = "right-eye", .start_ns = 2'000'000'000, .repeats = 1});
  WriteSmall(Data() / "sub/b", {.rig = "left", .camera = "sim:other", .start_ns = 3'000'000'000});
  WriteSmall(Data() / "bad", {.rig = "left"});
  FlipByte(Data() / "bad/manifest.log", 20);
  EXPECT_THAT(Names(), ElementsAre("a", "bad", "c", "sub/b"));
  EXPECT_THAT(Names("", "name desc"), ElementsAre("sub/b", "c", "bad", "a"));
  EXPECT_THAT(Names("", "start_time"), ElementsAre("bad", "a", "c", "sub/b"));
  EXPECT_THAT(Names("", "start_time desc"), ElementsAre("sub/b", "c", "a", "bad"));
  EXPECT_THAT(Names("rig = left"), ElementsAre("sub/b"));
  EXPECT_THAT(Names("rig = left*"), ElementsAre("c", "sub/b"));
  EXPECT_THAT(Names("rig != \"left*\" AND state != DAMAGED"), ElementsAre("a"));
  EXPECT_THAT(Names("name = recordings/sub/*"), ElementsAre("sub/b"));
  EXPECT_THAT(Names("camera = \"sim:other\""), ElementsAre("sub/b"));
  EXPECT_THAT(Names("origin = CAPTURED"), ElementsAre("a", "c", "sub/b"));
  EXPECT_THAT(Names("frames < 6 AND frames > 0"), ElementsAre("a"));
  EXPECT_THAT(Names("captures = 2 AND bytes >= 100 AND levels = 2 AND series:blue"),
              ElementsAre("a", "c", "sub/b"));
  EXPECT_THAT(Names("series:blu"), IsEmpty());
  EXPECT_THAT(Names("start_time <= 1970-01-01T00:00:02"), ElementsAre("a"))
      << "what is not known is neither early nor late";
  EXPECT_THAT(Names("start_time != 1970-01-01T00:00:02Z"), ElementsAre("c", "sub/b"));
  EXPECT_THAT(Names("rig = \"' OR 1=1 --\""), IsEmpty());
  EXPECT_EQ(told_.size(), 1u);
}

// No recording that is there throughout is left out or comes twice, whatever comes and goes.
TEST_F(CatalogueTest, PagesNeitherSkipNorRepeatWhileRecordingsComeAndGo) {
  for (const char* order : {"name", "name desc", "start_time", "start_time desc"}) {
    std::filesystem::remove_all(Data());
    std::filesystem::create_directories(Data());
    data_.emplace(*RootFolder::Open(Data()));
    std::vector<std::string> kept;
    for (const char* name : {"b", "d", "f", "h", "j", "l", "n"}) {
      // Equal times, so that the name decides too.
      WriteSmall(Data() / name, {.start_ns = int64_t{1'000'000'000} * (1 + name[0] % 3)});
      kept.push_back(name);
    }
    WriteSmall(Data() / "m", {});
    v1::ListRecordingsRequest request;
    request.set_page_size(2);
    request.set_order_by(order);
    std::vector<std::string> seen;
    for (int page = 0;; ++page) {
      const auto answer = Page(request);
      ASSERT_LE(answer.recordings_size(), 2);
      for (const auto& entry : answer.recordings()) seen.push_back(entry.name().substr(11));
      if (answer.next_page_token().empty()) break;
      ASSERT_LT(page, 20);
      request.set_page_token(answer.next_page_token());
      WriteSmall(Data() / std::string{static_cast<char>('a' + 2 * page)}, {});
      std::filesystem::remove_all(Data() / "m");
    }
    std::erase_if(
        seen, [&](const std::string& name) { return std::ranges::find(kept, name) == kept.end(); });
    std::ranges::sort(seen);
    EXPECT_EQ(seen, kept) << order;
  }
}

TEST_F(CatalogueTest, ReadersAnswerWhileAnotherWrites) {
  for (int i = 0; i < 30; ++i) WriteSmall(Data() / ("r" + std::to_string(100 + i)), {});
  EXPECT_EQ(Names().size(), 30u);
  std::atomic<bool> done = false;
  std::atomic<int> answers = 0;
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      v1::ListRecordingsRequest request;
      request.set_page_size(100);
      while (!done || answers < 3) {
        const auto page = catalogue_->Look(request);
        ASSERT_TRUE(page.ok()) << page.status();
        // Every answer is one moment's: rebuilt, or with recordings that come in the order of
        // names.
        ASSERT_GE(page->recordings_size(), 30);
        for (int k = 0; k < page->recordings_size(); ++k) {
          ASSERT_EQ(page->recordings(k).name(), "recordings/r" + std::to_string(100 + k));
        }
        ++answers;
      }
    });
  }
  for (int i = 30; i < 40; ++i) {
    WriteSmall(Data() / ("r" + std::to_string(100 + i)), {});
    EXPECT_TRUE(catalogue_->Refresh().ok());
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(Names().size(), 40u);
}

TEST_F(CatalogueTest, SeveralProcessesKeepOneFile) {
  for (int i = 0; i < 10; ++i) WriteSmall(Data() / ("r" + std::to_string(i)), {});
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    // Nothing is shared but the folders, as between processes.
    threads.emplace_back([this, i] {
      const auto data = RootFolder::Open(Data());
      Catalogue another(State(), &*data, &clock_, [](const std::string&) {});
      for (int k = 0; k < 10; ++k) {
        ASSERT_TRUE((i % 2 ? another.Rebuild("again") : another.Refresh()).ok());
        const auto page = another.List({});
        ASSERT_TRUE(page.ok()) << page.status();
        ASSERT_EQ(page->recordings_size(), 10);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST_F(CatalogueTest, StopIsHeardWhileAnotherProcessHoldsTheFile) {
  const OwnedFd lock(open((State() / "catalogue.lock").c_str(), O_RDWR | O_CREAT, 0600));
  ASSERT_EQ(flock(lock.get(), LOCK_EX), 0);
  std::thread waiting([&] { EXPECT_TRUE(absl::IsCancelled(catalogue_->Refresh())); });
  catalogue_->Stop();
  waiting.join();
}

TEST_F(CatalogueTest, StoppedItReadsNoMore) {
  WriteSmall(Data() / "a", {});
  catalogue_->Stop();
  EXPECT_TRUE(absl::IsCancelled(catalogue_->List({}).status()));
}

}  // namespace
}  // namespace eyebox::service

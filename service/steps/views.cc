#include "service/steps/views.h"

#include <algorithm>
#include <cctype>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/image_file.h"
#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "service/steps/captures.h"
#include "service/steps/levels.h"

namespace eyebox::service {
namespace {

absl::Status VisitRecording(const std::filesystem::path& folder,
                            const std::optional<std::string>& asked, const ViewVisitor& visit) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(folder));
  EYEBOX_ASSIGN_OR_RETURN(const std::string series, ChooseSeries(*reader, asked));
  for (const capture::CaptureEntry* entry : CapturesOfKind(*reader, FrameKind::kLight)) {
    if (entry->spec.series != series || entry->frame_count == 0) continue;
    Image<double> mean(entry->frame_size);
    EYEBOX_RETURN_IF_ERROR(reader->VisitFrames(*entry, [&](const Frame& frame) {
      const auto sum = mean.pixels();
      for (size_t i = 0; i < sum.size(); ++i) {
        sum[i] += static_cast<double>(frame.view.pixels_dn[i]) / entry->frame_count;
      }
      return absl::OkStatus();
    }));
    EYEBOX_RETURN_IF_ERROR(visit(absl::StrCat("capture ", entry->number), mean));
  }
  return absl::OkStatus();
}

bool IsImage(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".png" || extension == ".tif" || extension == ".tiff";
}

}  // namespace

absl::StatusOr<Image<double>> ReadView(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const StillImage still, ReadGreyImage(file));
  Image<double> view(still.pixels_dn.size());
  std::ranges::copy(still.pixels_dn.pixels(), view.pixels().begin());
  return view;
}

absl::Status VisitViews(const std::filesystem::path& source,
                        const std::optional<std::string>& series, const ViewVisitor& visit) {
  if (std::filesystem::exists(source / "recording.textproto")) {
    return VisitRecording(source, series, visit);
  }
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (auto entry = std::filesystem::directory_iterator(source, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (IsImage(entry->path())) files.push_back(entry->path());
  }
  if (error) return SystemFailed(source.string(), error.value(), "give a folder of views");
  if (files.empty()) {
    return Missing(source.string(), "holds no PNG or TIFF image and is no recording",
                   "give a folder of views of the target");
  }
  std::ranges::sort(files);
  for (const auto& file : files) {
    EYEBOX_ASSIGN_OR_RETURN(const Image<double> view, ReadView(file));
    EYEBOX_RETURN_IF_ERROR(visit(file.filename().string(), view));
  }
  return absl::OkStatus();
}

}  // namespace eyebox::service

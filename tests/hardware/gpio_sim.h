// A chip of the kernel's gpio-sim, made through configfs and taken down again.
#ifndef EYEBOX_TESTS_HARDWARE_GPIO_SIM_H_
#define EYEBOX_TESTS_HARDWARE_GPIO_SIM_H_

#include <filesystem>
#include <fstream>
#include <string>

namespace eyebox::capture {

class GpioSim {
 public:
  static bool IsAvailable() { return std::filesystem::is_directory("/sys/kernel/config/gpio-sim"); }

  // Four lines; number `line` is called `line_name`.
  GpioSim(const std::string& name, int line, const std::string& line_name)
      : config_("/sys/kernel/config/gpio-sim/" + name),
        named_(config_ / "bank" / ("line" + std::to_string(line))) {
    std::filesystem::create_directory(config_);
    std::filesystem::create_directory(config_ / "bank");
    Write(config_ / "bank/num_lines", "4");
    std::filesystem::create_directory(named_);
    Write(named_ / "name", line_name);
    Write(config_ / "live", "1");
    chip_ = FirstWord(config_ / "bank/chip_name");
    lines_ =
        std::filesystem::path("/sys/devices/platform") / FirstWord(config_ / "dev_name") / chip_;
  }
  ~GpioSim() {
    Write(config_ / "live", "0");
    for (const auto& folder : {named_, config_ / "bank", config_}) std::filesystem::remove(folder);
  }
  GpioSim(const GpioSim&) = delete;
  GpioSim& operator=(const GpioSim&) = delete;

  const std::string& chip() const { return chip_; }  // "gpiochip0"
  // What something outside would do to a line that is an input.
  void Pull(int line, bool up) { Write(Of(line) / "pull", up ? "pull-up" : "pull-down"); }
  // "0" or "1", as something outside would see it.
  std::string Value(int line) const { return FirstWord(Of(line) / "value"); }

 private:
  static void Write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }
  static std::string FirstWord(const std::filesystem::path& file) {
    std::string word;
    std::ifstream(file) >> word;
    return word;
  }
  std::filesystem::path Of(int line) const { return lines_ / ("sim_gpio" + std::to_string(line)); }

  const std::filesystem::path config_;
  const std::filesystem::path named_;
  std::string chip_;
  std::filesystem::path lines_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_HARDWARE_GPIO_SIM_H_

// Numbers of table files as text.
#ifndef EYEBOX_FIT_CUBE_CUBE_TEXT_H_
#define EYEBOX_FIT_CUBE_CUBE_TEXT_H_

#include <array>
#include <string>

namespace eyebox::fit {

// "R G B" and a line end, each in the shortest decimal form that reads back to the same float32.
void AppendTriplet(std::string& text, const std::array<double, 3>& triplet);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_CUBE_TEXT_H_

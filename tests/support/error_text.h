#pragma once

#include <gtest/gtest.h>

#include <string>

namespace s2s::test {

/// The text of the error that `action` throws; a failure if it throws none of that type.
template <class ErrorType, class Action>
std::string errorText(const Action& action) {
  try {
    action();
  } catch (const ErrorType& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error of the expected type";
  return "";
}

}  // namespace s2s::test

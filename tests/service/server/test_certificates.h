// A certificate authority for one test, and what it signs; made on the spot, for localhost.
#ifndef EYEBOX_TESTS_SERVICE_SERVER_TEST_CERTIFICATES_H_
#define EYEBOX_TESTS_SERVICE_SERVER_TEST_CERTIFICATES_H_

#include <memory>
#include <string>

namespace eyebox::service {

struct CertifiedKey {
  std::string certificate;  // PEM
  std::string key;          // PEM
};

class TestAuthority {
 public:
  explicit TestAuthority(const std::string& name);
  ~TestAuthority();

  const std::string& certificate() const { return certificate_; }  // PEM
  // Valid from an hour ago until `valid_s` seconds from now.
  CertifiedKey Issue(const std::string& name, long valid_s = 3600) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  std::string certificate_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_SERVER_TEST_CERTIFICATES_H_

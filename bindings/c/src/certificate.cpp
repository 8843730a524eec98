// SPDX-License-Identifier: MIT
#include "meshbound/certificate.h"

#include <optional>
#include <utility>

#include "arguments.h"
#include "guard.h"
#include "measurement.h"
#include "results.h"

using namespace meshbound;
using namespace meshbound::c_interface;

struct mb_certificate {
  Certificate certificate;
};

namespace {

CertificateOptions certificate_options(const mb_distance_options& given, RunControl& control) {
  const DistanceOptions wanted = library_options(given, control);
  CertificateOptions options;
  options.threads = wanted.threads;
  options.seconds = wanted.budget.seconds;
  options.cancel = wanted.cancel;
  options.progress = wanted.progress;
  return options;
}

}  // namespace

mb_status mb_certificate_new(const mb_mesh* original, const mb_mesh* simplified, double tolerance,
                             const mb_distance_options* options, mb_certificate** certificate) {
  return guarded(threads_of(options), [&] {
    require(certificate, "certificate");
    const mb_distance_options given = complete(options, mb_distance_options_init);
    RunControl control(given);
    std::optional<Certificate> proof =
        build_certificate(view_of(original, "original"), view_of(simplified, "simplified"), tolerance,
                          certificate_options(given, control));
    control.finish();
    if (!proof) throw Error("no certificate was found within the time limit");
    *certificate = new mb_certificate{std::move(*proof)};
  });
}

const uint8_t* mb_certificate_data(const mb_certificate* certificate) {
  return certificate == nullptr ? nullptr : certificate->certificate.bytes.data();
}

size_t mb_certificate_size(const mb_certificate* certificate) {
  return certificate == nullptr ? 0 : certificate->certificate.bytes.size();
}

void mb_certificate_free(mb_certificate* certificate) { delete certificate; }

#include "base/signals.h"

#include "base/file.h"
#include "base/log.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <thread>

namespace limn {
namespace {

/// Those that end a process, but none that somebody has told us to ignore, as nohup does.
sigset_t endingSignals() {
    sigset_t set;
    ::sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction now {};
        if (::sigaction(number, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) ::sigaddset(&set, number);
    }
    return set;
}

}  // namespace

void endCleanlyOnSignals() {
    const sigset_t set = endingSignals();
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread([set] {
        int number = 0;
        if (::sigwait(&set, &number) != 0) return;
        abandonPendingFiles();
        ::alarm(2);  // ends it where nobody takes what is said now
        log::status("");
        log::warning("ended by {}: what is saved is complete", ::strsignal(number));
        // Ends as it would have ended, so that shells and farms see why.
        std::signal(number, SIG_DFL);
        ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
        ::kill(::getpid(), number);
    }).detach();
}

void unblockSignals() {
    const sigset_t set = endingSignals();
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace limn

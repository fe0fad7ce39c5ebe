#include "base/error.h"
#include "base/install.h"
#include "image/codecs.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <thread>

namespace limn {

const ImageModule& imageModule() {
    static const ImageModule* module = [] {
        const auto path = moduleFolder() / "limn-oiio.so";
        void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library)
            throw Error(ExitCode::internal, {path.string()},
                fmt::format("the image module cannot be loaded ({})", dlerror()),
                "it belongs beside the program: build or install limn again");
        return static_cast<const ImageModule*>(dlsym(library, "limnImageModule"));
    }();
    return *module;
}

void preloadImageLibrary() {
    // Its own thread, not a task: a task would hold one of the workers that parse and draw.
    static std::jthread loader([] {
        try {
            imageModule();
        } catch (const Error&) {
            // Whoever needs the module will get the same error, and can report it.
        }
    });
}

}  // namespace limn

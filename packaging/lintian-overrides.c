# CPack writes these scripts for every shared library, beside our trigger.
libmeshbound-c1: maintscript-calls-ldconfig *

"""Where robots drive: worlds of files, of benchmarks, and generated ones."""

"""Requirements: signal temporal logic over sampled quantities, with its robustness.

Space robustness (Donze, Maler: Robust Satisfaction of Temporal Logic over Real-Valued Signals,
2010), exact for quantities that are straight or held between their samples, and with bounds where
the run ends before a window does (as in Deshmukh et al.: Robust Online Monitoring of STL, 2017).
"""
